#include "softforce/vision/recorder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <fstream>
#include <future>
#include <mutex>
#include <thread>

#include "softforce/base/input_error.h"
#include "vision/disk_sync.h"
#include "vision/new_recording.h"
#include "vision/recorded_folder.h"
#include "vision/segment_writer.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

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
  int64_t Compress(const FrameSet& frame, double time_s);
  bool Full(double newest_s) const;
  void NextSegment();
  void EndSegment();
  void WriteManifest(bool complete);
  void Complete();
  void Join();
};

void Recorder::State::WriteManifest(bool complete) {
  vision::WriteManifest(folder, {names, started, options, report, complete});
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

// The cameras' pictures side by side, each on a thread: on a busy computer one thread alone would
// not get the time to keep up.
int64_t Recorder::State::Compress(const FrameSet& frame, double time_s) {
  std::vector<std::future<int64_t>> written;
  for (size_t c = 0; c < cameras.size(); ++c) {
    const cv::Mat& picture = frame.pictures.at(c);
    const auto launch = c + 1 < cameras.size() ? std::launch::async : std::launch::deferred;
    written.push_back(std::async(launch, [this, c, picture, time_s] {
      CameraFiles& camera = cameras[c];
      if (!camera.segment) {
        camera.segment =
            std::make_unique<SegmentWriter>(SegmentFile(camera.folder, segment), picture.size());
      }
      return camera.segment->Add(picture, time_s);
    }));
  }
  int64_t bytes = 0;
  // The last one first, on this thread. Whichever throws, the others are waited for.
  for (auto each = written.rbegin(); each != written.rend(); ++each) bytes += each->get();
  return bytes;
}

bool Recorder::State::Full(double newest_s) const {
  if (queue.empty()) return false;
  return static_cast<int>(queue.size()) >= options.queue ||
         newest_s - queue.front().time_s > options.longest_wait_s;
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
  const int64_t bytes = Compress(frame, time_s);
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
  if (!(longest_wait_s > 0)) throw base::InputError("longest wait", "must be more than 0 s");
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

Recorder::Recorder(const fs::path& folder, const std::vector<std::string>& cameras,
                   const RecorderOptions& options)
    : state_(new State) {
  options.Check();
  CheckFolderNames(cameras);
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
    const auto full = [&] { return state_->Full(frame.time_s); };
    if (state_->options.wait) {
      state_->room.wait(lock, [&] { return state_->error || !full(); });
    }
    if (state_->error) std::rethrow_exception(state_->error);
    while (full()) {
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
