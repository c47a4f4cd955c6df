#include "softforce/vision/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <utility>

#include "softforce/base/input_error.h"
#include "vision/recorded_camera.h"
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

using Videos = std::vector<std::unique_ptr<PictureStream>>;

std::unique_ptr<PictureStream> OpenPictures(const std::vector<std::filesystem::path>& files,
                                            size_t c) {
  std::error_code ignored;
  if (std::filesystem::is_directory(files[c], ignored)) {
    return std::make_unique<RecordedCamera>(files[c]);
  }
  std::vector<std::filesystem::path> siblings = files;
  siblings.erase(siblings.begin() + static_cast<std::ptrdiff_t>(c));
  return std::make_unique<VideoFile>(files[c], siblings);
}

// Whether both are of one recording that was cut off while their pictures were written in turn.
bool CutTogether(const PictureStream& a, const PictureStream& b) {
  std::error_code ignored;
  return a.unfinished() && b.unfinished() &&
         std::filesystem::equivalent(a.file() / "..", b.file() / "..", ignored);
}

// Frames that the videos announce; 0 if none does.
int CommonLength(const Videos& videos) {
  const PictureStream* first = nullptr;
  int length = 0;
  for (const auto& video : videos) {
    const int announced = video->announced_frames();
    if (announced == 0) continue;
    if (first == nullptr) {
      first = video.get();
      length = announced;
    }
    if (announced != first->announced_frames() && !CutTogether(*video, *first)) {
      throw InputError(
          video->file().string(),
          fmt::format("has {} frames, but {} has {}", announced, first->file().string(),
                      first->announced_frames()),
          "The cameras' videos must be of the same length: frame k of one belongs to frame k of "
          "the others.");
    }
    length = std::min(length, announced);
  }
  return length;
}

void CheckSize(const PictureStream& video, const camera::Camera& camera) {
  const cv::Size size = video.size();
  if (size.width == camera.width && size.height == camera.height) return;
  throw InputError(video.file().string(),
                   fmt::format("pictures are {}x{} px, but camera \"{}\" of the rig is calibrated "
                               "for {}x{} px",
                               size.width, size.height, camera.name, camera.width, camera.height),
                   "Use the recording's own size, or calibrate the camera at this one.");
}

}  // namespace

struct Recording::State {
  std::vector<std::string> cameras;
  std::vector<std::unique_ptr<PictureStream>> videos;
  int announced = 0;
  std::filesystem::path unfinished;  // a recorded folder whose recorder was killed
  std::atomic<bool> stopped = false;

  std::mutex mutex;  // of all below
  int delivered = 0;
  bool ended = false;
  std::string truncation;
  bool told = false;

  // Where one of the videos has no more pictures.
  void End(const PictureStream& video) {
    const std::lock_guard lock(mutex);
    ended = true;
    if (delivered >= announced) return;
    truncation = fmt::format("{}: ended after {} of {} frames: the file was cut off or is damaged",
                             video.file().string(), delivered, announced);
  }
};

Recording::Recording(const camera::Rig& rig, const std::vector<Source>& sources)
    : state_(std::make_unique<State>()) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  RefuseUnknownCameras(rig, sources);
  std::vector<std::filesystem::path> files;
  for (const camera::Camera& camera : rig.cameras) {
    files.push_back(SourceOf(camera, sources).file);
    state_->cameras.push_back(camera.name);
  }
  for (size_t c = 0; c < files.size(); ++c) {
    state_->videos.push_back(OpenPictures(files, c));
    CheckSize(*state_->videos.back(), rig.cameras[c]);
    if (state_->videos.back()->unfinished()) state_->unfinished = files[c] / "..";
  }
  state_->announced = CommonLength(state_->videos);
}

Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;

int Recording::announced_frames() const { return state_->announced; }

std::optional<FrameSet> Recording::Next() {
  if (state_->ended || state_->stopped) return std::nullopt;
  FrameSet frame;
  frame.frame = state_->delivered;
  for (const auto& video : state_->videos) {
    std::optional<cv::Mat> picture = video->Next();
    if (!picture) {
      state_->End(*video);
      return std::nullopt;
    }
    frame.pictures.push_back(std::move(*picture));
    frame.camera_time_s.push_back(video->camera_time_s());
  }
  frame.time_s = state_->videos.front()->time_s();
  const std::lock_guard lock(state_->mutex);
  ++state_->delivered;
  return frame;
}

void Recording::Rewind() {
  for (const auto& video : state_->videos) video->Rewind();
  const std::lock_guard lock(state_->mutex);
  state_->delivered = 0;
  state_->ended = false;
  state_->truncation.clear();
}

void Recording::Stop() { state_->stopped = true; }

SourceReport Recording::Report() const {
  const std::lock_guard lock(state_->mutex);
  SourceReport report;
  report.delivered = state_->delivered;
  report.truncation = state_->truncation;
  for (const std::string& name : state_->cameras) {
    CameraReport camera;
    camera.camera = name;
    camera.state = state_->ended ? CameraReport::State::kEnded : CameraReport::State::kRunning;
    camera.received = camera.paired = state_->delivered;
    report.cameras.push_back(camera);
  }
  return report;
}

std::vector<std::string> Recording::TakeMessages() {
  const std::lock_guard lock(state_->mutex);
  if (state_->unfinished.empty() || std::exchange(state_->told, true)) return {};
  return {fmt::format("{}: the recorder was ended by force; it holds {} sets of pictures",
                      state_->unfinished.lexically_normal().string(), state_->announced)};
}

const std::string& Recording::truncation() const { return state_->truncation; }

}  // namespace softforce::vision
