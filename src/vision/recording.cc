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
#include "vision/videos_by_time.h"

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

// By how much the time stamps of each camera are taken to be late: as told, as the rig says, or, if
// it does not, as was known when they were recorded.
std::vector<double> TimeOffsets(const camera::Rig& rig, const Videos& videos,
                                const std::map<std::string, double>& told) {
  for (const auto& [name, offset] : told) {
    if (rig.Find(name)) continue;
    throw InputError("time offset", fmt::format("the rig has no camera \"{}\"", name));
  }
  std::vector<double> offsets_s;
  for (size_t c = 0; c < videos.size(); ++c) {
    const camera::Camera& camera = rig.cameras[c];
    const auto given = told.find(camera.name);
    const bool rig_says = camera.time_offset_s != 0 || camera.time_offset_sd_s > 0;
    offsets_s.push_back(given != told.end() ? given->second
                        : rig_says          ? camera.time_offset_s
                                            : videos[c]->time_offset_s());
  }
  return offsets_s;
}

bool AllAlike(const std::vector<double>& late_s) {
  constexpr double kSame = 1e-6;  // s; less is rounding
  const auto [least, most] = std::minmax_element(late_s.begin(), late_s.end());
  return *most - *least < kSame;
}

}  // namespace

struct Recording::State {
  std::vector<std::string> cameras;
  Videos videos;
  std::unique_ptr<VideosByTime> by_time;  // null: by number
  std::vector<double> time_offsets_s;
  int announced = 0;
  std::filesystem::path unfinished;  // a recorded folder whose recorder was killed
  std::atomic<bool> stopped = false;

  std::mutex mutex;  // of all below
  int delivered = 0;
  bool ended = false;
  std::string truncation;
  bool told = false;

  std::optional<FrameSet> NextByNumber();

  // Where one of the videos has no more pictures, having given so many of those that it should.
  void End(const PictureStream& video, int pictures, int expected) {
    const std::lock_guard lock(mutex);
    ended = true;
    if (pictures >= expected) return;
    truncation = fmt::format("{}: ended after {} of {} frames: the file was cut off or is damaged",
                             video.file().string(), pictures, expected);
  }
};

std::optional<FrameSet> Recording::State::NextByNumber() {
  FrameSet frame;
  for (const auto& video : videos) {
    std::optional<cv::Mat> picture = video->Next();
    if (!picture) {
      End(*video, delivered, announced);
      return std::nullopt;
    }
    frame.pictures.push_back(std::move(*picture));
    frame.camera_time_s.push_back(video->camera_time_s());
  }
  frame.time_s = videos.front()->time_s();
  return frame;
}

Recording::Recording(const camera::Rig& rig, const std::vector<Source>& sources,
                     const std::map<std::string, double>& time_offsets_s)
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
  state_->time_offsets_s = TimeOffsets(rig, state_->videos, time_offsets_s);
  std::vector<double> late_s = state_->time_offsets_s;  // that is, still
  for (size_t c = 0; c < late_s.size(); ++c) late_s[c] -= state_->videos[c]->time_offset_s();
  if (AllAlike(late_s)) return;
  state_->by_time = std::make_unique<VideosByTime>(state_->videos, std::move(late_s));
  state_->announced = std::max(0, state_->announced - state_->by_time->lag());
}

Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;

const std::vector<double>& Recording::time_offsets_s() const { return state_->time_offsets_s; }

int Recording::announced_frames() const { return state_->announced; }

std::optional<FrameSet> Recording::Next() {
  if (state_->ended || state_->stopped) return std::nullopt;
  std::optional<FrameSet> frame =
      state_->by_time ? state_->by_time->Next() : state_->NextByNumber();
  if (!frame) {
    if (state_->by_time) {
      const PictureStream& video = state_->by_time->ended();
      state_->End(video, state_->by_time->pictures_of_ended(), video.announced_frames());
    }
    return std::nullopt;
  }
  frame->frame = state_->delivered;
  const std::lock_guard lock(state_->mutex);
  ++state_->delivered;
  return frame;
}

void Recording::Rewind() {
  for (const auto& video : state_->videos) video->Rewind();
  if (state_->by_time) state_->by_time->Rewind();
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
