#include "pipeline/frame_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "pipeline/open_recording.h"
#include "pipeline/refusals.h"
#include "softforce/base/input_error.h"
#include "softforce/vision/live_cameras.h"

namespace softforce::pipeline {
namespace {

constexpr double kGrace = 2;  // s, that a live set may be late

std::unique_ptr<vision::FrameSource> OpenCameras(
    const camera::Rig& rig, const std::vector<vision::Recording::Source>& sources,
    const RunOptions& options) {
  std::map<std::string, std::string> by_camera;
  for (const auto& source : sources) by_camera[source.camera] = source.file.string();
  vision::LiveOptions live = options.live;
  live.stop = options.stop;
  return std::make_unique<vision::LiveCameras>(
      vision::LiveCamerasOf(rig, by_camera, options.time_offsets_s), live);
}

std::vector<std::string> NamesOf(const camera::Rig& rig) {
  std::vector<std::string> names;
  for (const camera::Camera& camera : rig.cameras) names.push_back(camera.name);
  return names;
}

std::string TextOf(const std::vector<vision::Recording::Source>& sources,
                   const std::string& camera) {
  for (const vision::Recording::Source& source : sources) {
    if (source.camera == camera) return source.file.string();
  }
  return "";
}

base::InputError StoppedEarly(size_t frames, int wanted) {
  return {"--registration-frames",
          fmt::format("the run was stopped after {} of the {} frames that place the rig", frames,
                      wanted),
          "Let it run for longer, or ask for fewer."};
}

}  // namespace

FrameFeed::FrameFeed(const scene::Scene& scene, const camera::Rig& rig, const RunOptions& options)
    : scene_(scene),
      rig_(rig),
      options_(options),
      sources_(SourcesOf(scene, options.sources)),
      live_(AreLive(sources_)) {
  const std::vector<std::filesystem::path> files = FilesOf(scene, sources_);
  RefuseToOverwrite(files, options.out);
  if (!options.record.empty()) {
    RefuseToRecordAPart();
    vision::RefuseUsedFolder(options.record);
  }
  if (!live_) {
    source_ = std::make_unique<vision::Recording>(OpenRecording(
        scene, rig, sources_, options.first_frame, "--frames", options.time_offsets_s));
  }
}

FrameFeed::~FrameFeed() = default;

// The rig is placed by the first frames of a recording: those of a part would be others.
void FrameFeed::RefuseToRecordAPart() const {
  if (options_.every > 1) {
    throw base::InputError("--record",
                           fmt::format("cannot go with --every {}: the frames left out, which help "
                                       "to place the rig, would not be recorded",
                                       options_.every),
                           "Leave out --every or --record.");
  }
  if (options_.first_frame == 0 && options_.end_frame >= options_.registration_frames) return;
  throw base::InputError(
      "--record",
      fmt::format("cannot go with --frames {}:{}: the first {} frames, which place the rig, must "
                  "all be recorded for the recording to give the same results",
                  options_.first_frame, options_.end_frame, options_.registration_frames),
      "Leave out --frames or --record.");
}

void FrameFeed::Start(SourceWatch::Tell tell) {
  if (live_) source_ = OpenCameras(rig_, sources_, options_);
  // Files do not keep anybody waiting: there Next() sees that it is to stop.
  watch_.emplace(source_.get(), live_ ? options_.stop : nullptr, std::move(tell));
}

ShowFirstFrames FrameFeed::FirstFrames() {
  return [this](const std::function<void(const vision::FrameSet&)>& look_at) {
    const auto look = [&](const vision::FrameSet& set) {
      if (set.time_s < options_.duration_s) look_at(set);
    };
    if (auto* recording = dynamic_cast<vision::Recording*>(source_.get())) {
      FirstFramesOf(recording, options_.registration_frames)(look);
      return;
    }
    // All are fetched before any is looked at: the cameras do not wait.
    while (static_cast<int>(kept_.size()) < options_.registration_frames) {
      std::optional<vision::FrameSet> set = source_->Next();
      if (!set) throw StoppedEarly(kept_.size(), options_.registration_frames);
      kept_.push_back(std::move(*set));
    }
    for (const vision::FrameSet& set : kept_) look(set);
  };
}

std::optional<vision::FrameSet> FrameFeed::Take() {
  if (kept_.empty()) return source_->Next();
  vision::FrameSet set = std::move(kept_.front());
  kept_.pop_front();
  return set;
}

std::optional<vision::FrameSet> FrameFeed::Next() {
  while (true) {
    stopped_ = Stopped();
    if (stopped_) return std::nullopt;
    std::optional<vision::FrameSet> set = Take();
    if (!set || set->frame >= options_.end_frame || set->time_s >= options_.duration_s) {
      return std::nullopt;
    }
    if (set->frame < options_.first_frame) continue;
    // The times of frames say when it is over; the clock does if the cameras stay away.
    if (live_ && set->frame == 0) watch_->StopAfter(options_.duration_s + kGrace);
    if ((set->frame - options_.first_frame) % options_.every != 0) continue;
    Record(*set);
    return set;
  }
}

void FrameFeed::Record(const vision::FrameSet& set) {
  if (options_.controls != nullptr) options_.controls->can_record = options_.record.empty();
  if (!ToBeRecorded()) {
    if (recorder_) EndRecording();
    return;
  }
  const std::vector<std::string> names = NamesOf(rig_);
  vision::RecorderOptions recorder;
  recorder.wait = true;  // live cameras then drop what is neither recorded nor processed
  for (const std::string& name : names) recorder.sources.push_back(TextOf(sources_, name));
  recorder.time_offsets_s = TimeOffsets();
  if (!recorder_) recorder_.emplace(RecordFolder(), names, recorder);
  if (options_.controls != nullptr) options_.controls->recording = true;
  recorder_->Add(set);
}

bool FrameFeed::ToBeRecorded() const {
  return !options_.record.empty() || (options_.controls != nullptr && options_.controls->record);
}

std::filesystem::path FrameFeed::RecordFolder() {
  if (!options_.record.empty()) return options_.record;
  std::filesystem::path folder;
  do {
    folder = options_.out / fmt::format("recording-{}", ++recordings_);
  } while (std::filesystem::exists(folder));
  return folder;
}

void FrameFeed::EndRecording() {
  recorder_->Finish();
  if (options_.controls != nullptr) options_.controls->recording = false;
  if (options_.record.empty()) {
    const std::filesystem::path folder = options_.out / fmt::format("recording-{}", recordings_);
    recorded_.push_back(fmt::format("recorded on request: {}, {}", folder.string(),
                                    recorder_->Report().BriefReport()));
    recorder_.reset();
  }
}

std::vector<double> FrameFeed::TimeOffsets() const {
  if (const auto* recording = dynamic_cast<const vision::Recording*>(source_.get())) {
    return recording->time_offsets_s();
  }
  std::vector<double> offsets_s;
  for (const auto& camera : dynamic_cast<const vision::LiveCameras&>(*source_).cameras()) {
    offsets_s.push_back(camera.time_offset_s);
  }
  return offsets_s;
}

void FrameFeed::Finish() {
  if (live_) source_->Stop();
  if (recorder_) EndRecording();
}

int FrameFeed::expected_frames() const {
  const int announced = source_->announced_frames();
  if (announced == 0) return 0;
  const int frames = std::min(options_.end_frame, announced) - options_.first_frame;
  return (frames + options_.every - 1) / options_.every;
}

std::optional<vision::RecorderReport> FrameFeed::Recorded() const {
  return recorder_ ? std::optional(recorder_->Report()) : std::nullopt;
}

std::vector<std::filesystem::path> FrameFeed::Inputs() const { return InputsOf(scene_, sources_); }

std::vector<std::string> FrameFeed::ShortOf() const {
  std::vector<std::string> short_of;
  const std::string truncation = source_->Report().truncation;
  if (!truncation.empty()) short_of.push_back(truncation);
  if (stopped_ && !live_) short_of.emplace_back("stopped before the end of the recording");
  return short_of;
}

std::vector<std::string> FrameFeed::Messages() const {
  std::vector<std::string> messages = watch_ ? watch_->Messages() : std::vector<std::string>();
  messages.insert(messages.end(), recorded_.begin(), recorded_.end());
  return messages;
}

}  // namespace softforce::pipeline
