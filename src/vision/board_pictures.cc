#include "softforce/vision/board_pictures.h"

#include <fmt/format.h>

#include <deque>
#include <opencv2/imgcodecs.hpp>

#include "softforce/base/input_error.h"
#include "vision/video_file.h"

namespace softforce::vision {
namespace {

using base::InputError;

// Videos that announce different lengths do not belong together.
void RefuseOtherLengths(const std::deque<VideoFile>& videos) {
  for (const VideoFile& video : videos) {
    const VideoFile& first = videos.front();
    if (video.announced_frames() == 0 || first.announced_frames() == 0 ||
        video.announced_frames() == first.announced_frames()) {
      continue;
    }
    throw InputError(video.file().string(),
                     fmt::format("has {} frames, but {} has {}", video.announced_frames(),
                                 first.file().string(), first.announced_frames()),
                     "Frame k of one video must belong to frame k of the others: record all "
                     "cameras together, or cut the videos to the same frames.");
  }
}

}  // namespace

struct BoardPictures::State {
  std::vector<CameraInput> cameras;
  std::deque<VideoFile> videos;
  std::vector<cv::Size> sizes;  // of each camera's first picture
  std::vector<std::string> first_files;
  int next = 0;

  cv::Mat Read(size_t camera, const std::filesystem::path& file);
};

cv::Mat BoardPictures::State::Read(size_t camera, const std::filesystem::path& file) {
  // As stored, whatever the camera noted about how it was held: calibration is of the sensor.
  cv::Mat grey = cv::imread(file.string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  if (grey.empty()) {
    throw InputError(file.string(), "cannot be read as a picture",
                     "Open it in a viewer to see what is wrong; leave it out if it is damaged.");
  }
  if (sizes[camera].empty()) {
    sizes[camera] = grey.size();
    first_files[camera] = file.string();
  }
  if (sizes[camera] != grey.size()) {
    throw InputError(file.string(),
                     fmt::format("is {}x{} px, but {} of the same camera \"{}\" is {}x{} px",
                                 grey.cols, grey.rows, first_files[camera], cameras[camera].camera,
                                 sizes[camera].width, sizes[camera].height),
                     "A calibration is of one resolution: leave out the pictures of the other.");
  }
  return grey;
}

BoardPictures::BoardPictures(std::vector<CameraInput> cameras) : state_(std::make_unique<State>()) {
  state_->cameras = std::move(cameras);
  state_->sizes.resize(state_->cameras.size());
  state_->first_files.resize(state_->cameras.size());
  for (const CameraInput& camera : state_->cameras) {
    if (!camera.video.empty()) {
      state_->videos.emplace_back(camera.video, std::vector<std::filesystem::path>{});
    }
  }
  if (is_video()) RefuseOtherLengths(state_->videos);
}
BoardPictures::~BoardPictures() = default;
BoardPictures::BoardPictures(BoardPictures&&) noexcept = default;

const std::vector<CameraInput>& BoardPictures::cameras() const { return state_->cameras; }

bool BoardPictures::is_video() const { return !state_->videos.empty(); }

int BoardPictures::announced_sets() const {
  if (is_video()) return state_->videos.front().announced_frames();
  return state_->cameras.empty() ? 0 : static_cast<int>(state_->cameras.front().pictures.size());
}

std::optional<PictureSet> BoardPictures::Next() {
  PictureSet set;
  set.number = state_->next;
  for (size_t c = 0; c < state_->cameras.size(); ++c) {
    if (is_video()) {
      VideoFile& video = state_->videos[c];
      std::optional<cv::Mat> picture = video.Next();
      if (!picture) return std::nullopt;
      set.sources.push_back(fmt::format("{} frame {}", video.file().string(), state_->next));
      set.pictures.push_back(std::move(*picture));
    } else {
      const auto& pictures = state_->cameras[c].pictures;
      if (state_->next >= static_cast<int>(pictures.size())) return std::nullopt;
      const CameraInput::Picture& picture = pictures[state_->next];
      set.number = picture.number;
      set.sources.push_back(picture.file.string());
      set.pictures.push_back(state_->Read(c, picture.file));
    }
  }
  ++state_->next;
  return set;
}

int BoardPictures::Skip(int sets) {
  int skipped = 0;
  for (; skipped < sets; ++skipped) {
    if (is_video()) {
      for (VideoFile& video : state_->videos) {
        if (!video.Next()) return skipped;
      }
    } else if (state_->next >= announced_sets()) {
      return skipped;
    }
    ++state_->next;
  }
  return skipped;
}

}  // namespace softforce::vision
