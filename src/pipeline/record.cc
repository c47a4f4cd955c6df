#include "softforce/pipeline/record.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "softforce/base/input_error.h"
#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

using Clock = std::chrono::steady_clock;
using base::InputError;

constexpr std::chrono::milliseconds kLook(50);
constexpr double kPatience = 10;  // s, for the first set, where a duration is given
constexpr size_t kMaxMessages = 100;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<vision::LiveCamera> CamerasOf(const RecordOptions& options) {
  if (!options.rig.empty()) {
    return vision::LiveCamerasOf(scene::LoadRig(options.rig), options.sources,
                                 options.time_offsets_s);
  }
  std::vector<vision::LiveCamera> cameras;
  for (const auto& [name, source] : options.sources) {
    const auto offset = options.time_offsets_s.find(name);
    cameras.push_back(
        {name, source, options.size, offset == options.time_offsets_s.end() ? 0 : offset->second});
  }
  for (const auto& [name, offset] : options.time_offsets_s) {
    if (options.sources.count(name) > 0) continue;
    throw InputError("--time-offset", fmt::format("there is no camera \"{}\"", name),
                     "Name one that --camera gives.");
  }
  return cameras;
}

// Ends a recording from a thread of its own, since the one that records may wait for a camera; and
// tells how it fares.
class Watch {
 public:
  Watch(const RecordOptions& options, vision::LiveCameras* cameras,
        const vision::Recorder* recorder)
      : options_(options), cameras_(cameras), recorder_(recorder), thread_([this] { Look(); }) {}
  ~Watch() {
    over_ = true;
    thread_.join();
  }

  void FirstSet() { first_set_ = true; }
  std::vector<std::string> End() {
    over_ = true;
    thread_.join();
    thread_ = std::thread([] {});
    return std::move(messages_);
  }

 private:
  bool IsTime(double seconds, double since_first_s) const {
    if (options_.stop != nullptr && *options_.stop) return true;
    return first_set_ ? since_first_s > options_.duration_s
                      : seconds > options_.duration_s + options_.live.settle_s + kPatience;
  }

  void Look() {
    const auto start = Clock::now();
    auto first = start, shown = start;
    const bool terminal = isatty(STDERR_FILENO) == 1;
    const double interval_s = terminal ? 0.5 : 10;
    while (!over_) {
      std::this_thread::sleep_for(kLook);
      if (!first_set_) first = Clock::now();
      if (IsTime(SecondsSince(start), SecondsSince(first))) cameras_->Stop();
      for (const std::string& message : cameras_->TakeMessages()) {
        if (options_.show_progress)
          fmt::print(stderr, "{}{}\n", terminal ? "\r\033[K" : "", message);
        if (messages_.size() < kMaxMessages) messages_.push_back(message);
      }
      if (!options_.show_progress || SecondsSince(shown) < interval_s) continue;
      shown = Clock::now();
      fmt::print(stderr, terminal ? "\r{}\033[K" : "{}\n", Line());
      std::fflush(stderr);
    }
    if (options_.show_progress && terminal) fmt::print(stderr, "\r\033[K");
  }

  std::string Line() const {
    const vision::SourceReport source = cameras_->Report();
    const vision::RecorderReport recorder = recorder_->Report();
    std::string text = fmt::format("{} sets, {:.1f} s", recorder.written, recorder.seconds);
    int64_t unpaired = 0;
    for (const vision::CameraReport& camera : source.cameras) {
      unpaired += camera.unpaired + camera.unsure;
      const bool runs = camera.state == vision::CameraReport::State::kRunning;
      text += runs ? fmt::format(", {} {:.1f} per second", camera.camera, camera.rate_hz)
                   : fmt::format(", {} away", camera.camera);
    }
    text += fmt::format(", {} dropped, {} unpaired, {} waiting", source.dropped + recorder.dropped,
                        unpaired, source.queued + recorder.queued);
    return text;
  }

  const RecordOptions& options_;
  vision::LiveCameras* cameras_;
  const vision::Recorder* recorder_;
  std::atomic<bool> over_ = false, first_set_ = false;
  std::vector<std::string> messages_;  // of the thread, until it has ended
  std::thread thread_;
};

}  // namespace

void RecordOptions::Check() const {
  if (sources.empty()) {
    throw InputError("record", "no camera is given", "Name each with --camera NAME=SOURCE.");
  }
  if (out.empty()) throw InputError("--out", "is empty", "Name a folder for the recording.");
  if (!(duration_s > 0)) throw InputError("--duration", "must be more than 0 s");
  live.Check();
  recorder.Check();
}

std::string RecordReport::FullReport() const {
  std::string text = recorder.BriefReport() + "\n";
  if (source.dropped > 0) {
    text +=
        fmt::format("  {} more sets were dropped before the recorder took them\n", source.dropped);
  }
  for (const vision::CameraReport& camera : source.cameras) {
    text += "  " + camera.BriefReport() + "\n";
  }
  for (const std::string& message : messages) text += "  " + message + "\n";
  if (!usable()) return text + "\nNo set of pictures was recorded.\n";
  text += fmt::format("\nRecording: {}\nReplay:", out.string());
  for (const std::string& camera : cameras) {
    text += fmt::format(" --camera {}={}", camera, (out / camera).string());
  }
  return text + "\n";
}

RecordReport Record(const RecordOptions& options) {
  options.Check();
  vision::RefuseUsedFolder(options.out);
  vision::LiveOptions live = options.live;
  live.stop = options.stop;
  vision::LiveCameras cameras(CamerasOf(options), live);
  RecordReport report;
  report.out = options.out;
  if (options.stop != nullptr && *options.stop) return report;  // no folder for nothing
  vision::RecorderOptions recorder_options = options.recorder;
  for (const vision::LiveCamera& camera : cameras.cameras()) {
    report.cameras.push_back(camera.name);
    recorder_options.sources.push_back(camera.source);
    recorder_options.time_offsets_s.push_back(camera.time_offset_s);
  }
  vision::Recorder recorder(options.out, report.cameras, recorder_options);
  Watch watch(options, &cameras, &recorder);
  while (const auto set = cameras.Next()) {
    watch.FirstSet();
    if (set->time_s > options.duration_s) break;
    recorder.Add(*set);
  }
  report.source = cameras.Report();
  report.messages = watch.End();
  recorder.Finish();
  report.recorder = recorder.Report();
  return report;
}

}  // namespace softforce::pipeline
