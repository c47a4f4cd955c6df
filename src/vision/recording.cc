#include "softforce/vision/recording.h"

#include <fmt/format.h>

#include <opencv2/core/utils/logger.hpp>

#include "softforce/base/input_error.h"
#include "vision/video_file.h"

namespace softforce::vision {
namespace {

using base::InputError;

const Recording::Source& SourceOf(const camera::Camera& camera,
                                  const std::vector<Recording::Source>& sources) {
  for (const Recording::Source& source : sources) {
    if (source.camera == camera.name) return source;
  }
  throw InputError("cameras: sources",
                   fmt::format("camera \"{}\" of the rig has no source", camera.name),
                   fmt::format("Name one under 'sources', or with --camera {}=FILE.", camera.name));
}

void RefuseUnknownCameras(const camera::Rig& rig, const std::vector<Recording::Source>& sources) {
  for (const Recording::Source& source : sources) {
    if (rig.Find(source.camera)) continue;
    std::string names;
    for (const camera::Camera& camera : rig.cameras) names += " \"" + camera.name + "\"";
    throw InputError("cameras: sources",
                     fmt::format("the rig has no camera \"{}\"; it has:{}", source.camera, names));
  }
}

// Frames that the videos announce; 0 if none does.
int CommonLength(const std::vector<VideoFile>& videos) {
  const VideoFile* first = nullptr;
  for (const VideoFile& video : videos) {
    if (video.announced_frames() == 0) continue;
    if (first == nullptr) first = &video;
    if (video.announced_frames() == first->announced_frames()) continue;
    throw InputError(
        video.file().string(),
        fmt::format("has {} frames, but {} has {}", video.announced_frames(),
                    first->file().string(), first->announced_frames()),
        "The cameras' videos must be of the same length: frame k of one belongs to frame k of "
        "the others.");
  }
  return first == nullptr ? 0 : first->announced_frames();
}

}  // namespace

struct Recording::State {
  std::vector<VideoFile> videos;
  int announced = 0;
  int delivered = 0;
  bool ended = false;
  std::string truncation;
};

Recording::Recording(const camera::Rig& rig, const std::vector<Source>& sources)
    : state_(std::make_unique<State>()) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  RefuseUnknownCameras(rig, sources);
  std::vector<std::filesystem::path> files;
  for (const camera::Camera& camera : rig.cameras) files.push_back(SourceOf(camera, sources).file);
  for (size_t c = 0; c < files.size(); ++c) {
    std::vector<std::filesystem::path> siblings = files;
    siblings.erase(siblings.begin() + static_cast<std::ptrdiff_t>(c));
    state_->videos.emplace_back(files[c], siblings);
    const VideoFile& video = state_->videos.back();
    const camera::Camera& camera = rig.cameras[c];
    if (video.width() != camera.width || video.height() != camera.height) {
      throw InputError(
          files[c].string(),
          fmt::format("pictures are {}x{} px, but camera \"{}\" of the rig is calibrated for "
                      "{}x{} px",
                      video.width(), video.height(), camera.name, camera.width, camera.height),
          "Use the recording's own size, or calibrate the camera at this one.");
    }
  }
  state_->announced = CommonLength(state_->videos);
}

Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;

int Recording::announced_frames() const { return state_->announced; }

std::optional<FrameSet> Recording::Next() {
  if (state_->ended) return std::nullopt;
  FrameSet frame;
  frame.frame = state_->delivered;
  for (VideoFile& video : state_->videos) {
    std::optional<cv::Mat> picture = video.Next();
    if (!picture) {
      state_->ended = true;
      if (state_->delivered < state_->announced) {
        state_->truncation =
            fmt::format("{}: ended after {} of {} frames: the file was cut off or is damaged",
                        video.file().string(), state_->delivered, state_->announced);
      }
      return std::nullopt;
    }
    frame.pictures.push_back(std::move(*picture));
  }
  frame.time_s = state_->videos.front().time_s();
  ++state_->delivered;
  return frame;
}

void Recording::Rewind() {
  for (VideoFile& video : state_->videos) video.Rewind();
  state_->delivered = 0;
  state_->ended = false;
  state_->truncation.clear();
}

const std::string& Recording::truncation() const { return state_->truncation; }

}  // namespace softforce::vision
