#include "softforce/vision/recorder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "vision/disk_sync.h"
#include "vision/recorded_folder.h"
#include "vision/segment_writer.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

void CheckCameras(const std::vector<std::string>& cameras) {
  std::set<std::string> seen;
  for (const std::string& camera : cameras) {
    const bool is_folder_name = !camera.empty() && camera != "." && camera != ".." &&
                                camera.find('/') == std::string::npos && camera[0] != '-';
    if (!is_folder_name || !seen.insert(camera).second) {
      throw base::InputError("record",
                             fmt::format(is_folder_name ? "two cameras are called \"{}\""
                                                        : "\"{}\" cannot name a camera's folder",
                                         camera),
                             "Give each camera a name of its own, of letters, digits and _.");
    }
  }
  if (cameras.empty()) {
    throw base::InputError("record", "there is no camera", "Name one with --camera NAME=SOURCE.");
  }
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw base::InputError(folder.string(), "the folder cannot be made: " + error.message(),
                         "Choose another.");
}

// A camera's folder, and what is open in it.
struct CameraFiles {
  fs::path folder;
  std::ofstream times;
  std::unique_ptr<SegmentWriter> segment;
};

}  // namespace

struct Recorder::State {
  fs::path folder;
  std::vector<std::string> names;
  RecorderOptions options;
  std::string started;  // UTC
  // Of the worker alone:
  std::vector<CameraFiles> cameras;
  int segment = -1;
  double first_s = 0, segment_start_s = 0;
  DiskSync sync;

  mutable std::mutex mutex;  // of all below
  std::condition_variable more, room;
  std::deque<FrameSet> queue;
  bool ending = false;
  std::exception_ptr error;
  RecorderReport report;
  std::thread worker;

  void Work();
  void Write(const FrameSet& frame);
  void NextSegment();
  void EndSegment();
  void WriteManifest(bool complete);
  void Complete();
  void Join();
};

void Recorder::State::WriteManifest(bool complete) {
  base::PendingFile file(folder / kManifest);
  {
    std::ofstream out(file.temporary());
    out << "softforce_recording: 1\n";
    out << "started: " << started << "\n";
    out << "codec: magicyuv, grey, lossless\n";
    out << fmt::format("segment: {} s\n", options.segment_s);
    out << "cameras:\n";
    for (size_t c = 0; c < names.size(); ++c) {
      const std::string source = c < options.sources.size() ? options.sources[c] : "";
      std::string quoted;
      for (const char letter : source) {
        quoted += letter == '\'' ? "''" : std::string(1, letter);
      }
      out << fmt::format("  - {{name: {}, source: '{}'}}\n", names[c], quoted);
    }
    out << fmt::format("frames: {}\n", report.written);
    out << fmt::format("dropped: {}\n", report.dropped);
    out << (complete ? kCompleteLine : "complete: false") << "\n";
  }
  SyncToDisk(file.temporary());
  file.Commit();
  SyncToDisk(folder);
}

void Recorder::State::NextSegment() {
  EndSegment();
  ++segment;
}

void Recorder::State::EndSegment() {
  for (CameraFiles& camera : cameras) {
    if (!camera.segment) continue;
    camera.segment->Finish();
    camera.segment.reset();
    sync.Add(SegmentFile(camera.folder, segment));
    sync.Add(camera.folder / kTimesFile);
    sync.Add(camera.folder);
  }
}

void Recorder::State::Write(const FrameSet& frame) {
  const auto start = Clock::now();
  const int number = static_cast<int>(report.written);
  if (number == 0) first_s = frame.time_s;
  const double time_s = frame.time_s - first_s;
  if (segment < 0 || time_s - segment_start_s >= options.segment_s) {
    NextSegment();
    segment_start_s = time_s;
  }
  int64_t bytes = 0;
  for (size_t c = 0; c < cameras.size(); ++c) {
    CameraFiles& camera = cameras[c];
    const cv::Mat& picture = frame.pictures.at(c);
    if (!camera.segment) {
      camera.segment =
          std::make_unique<SegmentWriter>(SegmentFile(camera.folder, segment), picture.size());
    }
    bytes += camera.segment->Add(picture, time_s);
  }
  // Only now: a line in times.csv means that the pictures of all cameras are there.
  for (size_t c = 0; c < cameras.size(); ++c) {
    const double camera_s =
        c < frame.camera_time_s.size() ? frame.camera_time_s[c] - first_s : time_s;
    cameras[c].times << FormatTime({number, time_s, camera_s, segment}) << "\n" << std::flush;
    if (cameras[c].times) continue;
    throw base::InputError((cameras[c].folder / kTimesFile).string(), "cannot be written",
                           "Check the disk's space.");
  }
  const std::lock_guard lock(mutex);
  ++report.written;
  report.bytes += bytes;
  report.seconds = time_s;
  report.busy_s += std::chrono::duration<double>(Clock::now() - start).count();
}

void Recorder::State::Work() {
  while (true) {
    FrameSet frame;
    {
      std::unique_lock lock(mutex);
      more.wait(lock, [&] { return ending || !queue.empty(); });
      if (queue.empty()) return;
      frame = std::move(queue.front());
      queue.pop_front();
    }
    room.notify_one();
    try {
      Write(frame);
    } catch (...) {
      const std::lock_guard lock(mutex);
      error = std::current_exception();
      queue.clear();
      room.notify_one();
      return;
    }
  }
}

void Recorder::State::Join() {
  {
    const std::lock_guard lock(mutex);
    ending = true;
  }
  more.notify_all();
  if (worker.joinable()) worker.join();
}

void Recorder::State::Complete() {
  if (error) std::rethrow_exception(error);
  EndSegment();
  sync.Finish();
  WriteManifest(true);
}

void RecorderOptions::Check() const {
  if (!(segment_s >= 0.1 && segment_s <= 3600)) {
    throw base::InputError("--segment", fmt::format("got {} s, must be 0.1 s to 1 h", segment_s));
  }
  if (queue < 1) throw base::InputError("--queue", "must be 1 or more sets of pictures");
}

std::string RecorderReport::BriefReport() const {
  std::string text = fmt::format("{} sets in {:.1f} s recorded, {:.1f} MB", written, seconds,
                                 1e-6 * static_cast<double>(bytes));
  if (seconds > 0)
    text += fmt::format(" ({:.1f} MB/s)", 1e-6 * static_cast<double>(bytes) / seconds);
  if (dropped > 0)
    text += fmt::format(", {} dropped since they could not be written in time", dropped);
  return text;
}

void RefuseUsedFolder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return;
  if (!fs::is_directory(folder, ignored)) {
    throw base::InputError(folder.string(), "is a file, expected a folder to record to",
                           "Choose another.");
  }
  if (fs::is_empty(folder, ignored)) return;
  throw base::InputError(folder.string(),
                         fs::exists(folder / kManifest, ignored)
                             ? "already holds a recording, which is not overwritten"
                             : "is not empty; a recording gets a folder of its own",
                         "Choose another, or remove it.");
}

Recorder::Recorder(const fs::path& folder, const std::vector<std::string>& cameras,
                   const RecorderOptions& options)
    : state_(new State) {
  options.Check();
  CheckCameras(cameras);
  RefuseUsedFolder(folder);
  State& state = *state_;
  state.folder = folder;
  state.names = cameras;
  state.options = options;
  state.started = fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  MakeFolder(folder);
  for (const std::string& name : cameras) {
    CameraFiles files;
    files.folder = folder / name;
    MakeFolder(files.folder);
    files.times.open(files.folder / kTimesFile);
    files.times << kTimesHeader << "\n" << std::flush;
    if (!files.times) {
      throw base::InputError((files.folder / kTimesFile).string(), "cannot be written",
                             "Check the folder's permissions and the disk's space.");
    }
    state.cameras.push_back(std::move(files));
  }
  state.WriteManifest(false);
  state.worker = std::thread([this] { state_->Work(); });
}

Recorder::~Recorder() {
  if (!state_->worker.joinable()) return;
  state_->Join();
  try {
    state_->Complete();
  } catch (const std::exception&) {  // said in the header: who wants to know calls Finish()
  }
}

void Recorder::Add(const FrameSet& frame) {
  {
    std::unique_lock lock(state_->mutex);
    const auto full = [&] {
      return static_cast<int>(state_->queue.size()) >= state_->options.queue;
    };
    if (state_->options.wait) {
      state_->room.wait(lock, [&] { return state_->error || !full(); });
    }
    if (state_->error) std::rethrow_exception(state_->error);
    if (full()) {
      state_->queue.pop_front();
      ++state_->report.dropped;
    }
    state_->queue.push_back(frame);
  }
  state_->more.notify_one();
}

void Recorder::Finish() {
  state_->Join();
  state_->Complete();
}

RecorderReport Recorder::Report() const {
  const std::lock_guard lock(state_->mutex);
  RecorderReport report = state_->report;
  report.queued = static_cast<int>(state_->queue.size());
  return report;
}

}  // namespace softforce::vision
