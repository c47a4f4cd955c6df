#include "softforce/vision/live_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "softforce/base/input_error.h"
#include "vision/camera_stream.h"
#include "vision/live_checks.h"
#include "vision/pairer.h"
#include "vision/stamp_clock.h"

namespace softforce::vision {
namespace {

using base::InputError;

constexpr double kFirstPause = 0.25;            // s, before a lost camera is opened again; doubles
constexpr std::chrono::milliseconds kLook(50);  // whether somebody asked to stop
constexpr double kSilence = 5;                  // s without a set, before that is worth a message

std::string WrongSize(cv::Size got, cv::Size expected) {
  return fmt::format("its pictures are {}x{} px, expected {}x{} px", got.width, got.height,
                     expected.width, expected.height);
}

// What one camera's thread keeps. Guarded by State's mutex, but for `thread`.
struct Channel {
  size_t index;
  LiveCamera camera;
  CameraReport report;
  StampClock clock;
  std::deque<double> arrivals_s;  // the last ones, for the rate
  double lost_s = NAN;            // when it was lost
  bool started = false;           // gave a picture once
  std::string failure;            // why it did not
  std::thread thread;
};

}  // namespace

struct LiveCameras::State {
  LiveOptions options;
  std::vector<LiveCamera> cameras;
  std::atomic<bool> stop = false;

  mutable std::mutex mutex;  // of all below
  std::condition_variable changed;
  std::deque<Channel> channels;
  std::unique_ptr<Pairer> pairer;
  std::deque<FrameSet> queue;
  double first_s = NAN;  // time of the first set
  int sets = 0;
  int64_t delivered = 0, dropped = 0;
  double last_set_s = NAN;
  bool silence_told = false;
  std::vector<std::string> messages;

  void Start();
  void Serve(Channel* channel);
  std::string GrabAll(Channel* channel, CameraStream* stream, Patience* patience);
  std::string Take(Channel* channel, CameraStream::Grabbed grabbed);
  void Lost(Channel* channel, const std::string& problem);
  void Queue(std::vector<TimedPicture> pictures);
  void WatchSilence(double now_s);
  void End();
};

// One set from pictures that belong together, into the queue.
void LiveCameras::State::Queue(std::vector<TimedPicture> pictures) {
  if (std::isnan(first_s)) first_s = pictures.front().time_s;
  FrameSet set;
  set.time_s = pictures.front().time_s - first_s;
  for (size_t c = 0; c < pictures.size(); ++c) {
    set.camera_time_s.push_back(pictures[c].time_s - first_s);
    set.pictures.push_back(std::move(pictures[c].grey));
    ++channels[c].report.paired;
  }
  queue.push_back(std::move(set));
  if (static_cast<int>(queue.size()) > options.queue) {
    queue.pop_front();
    ++dropped;
  }
}

void LiveCameras::State::WatchSilence(double now_s) {
  if (std::isnan(last_set_s)) last_set_s = now_s;
  if (silence_told || now_s - last_set_s < kSilence + options.settle_s) return;
  std::string counts;
  for (const Channel& channel : channels) {
    if (channel.report.state != CameraReport::State::kRunning) return;  // told already
    counts += fmt::format(" {}: {} unpaired, {} of uncertain time.", channel.camera.name,
                          channel.report.unpaired, channel.report.unsure);
  }
  messages.push_back(fmt::format(
      "all cameras deliver, but no pictures belong together.{} Is the computer busy, do "
      "they run at the same rate, and is their time offset set?",
      counts));
  silence_told = true;
}

// A picture of a camera; tells what is wrong with it.
std::string LiveCameras::State::Take(Channel* channel, CameraStream::Grabbed grabbed) {
  const std::lock_guard lock(mutex);
  LiveCamera& camera = channel->camera;
  CameraReport& report = channel->report;
  if (camera.size.empty()) camera.size = grabbed.grey.size();
  if (grabbed.grey.size() != camera.size) return WrongSize(grabbed.grey.size(), camera.size);
  if (report.state != CameraReport::State::kRunning) {
    report.state = CameraReport::State::kRunning;
    if (!std::isnan(channel->lost_s)) {
      messages.push_back(fmt::format("camera \"{}\": back after {:.1f} s", camera.name,
                                     grabbed.arrival_s - channel->lost_s));
      ++report.reopened;
      channel->lost_s = NAN;
      last_set_s = grabbed.arrival_s;  // its clock has to settle first
    }
  }
  channel->started = true;
  ++report.received;
  channel->arrivals_s.push_back(grabbed.arrival_s);
  if (channel->arrivals_s.size() > 60) channel->arrivals_s.pop_front();
  const StampClock::Stamp stamp = grabbed.exact
                                      ? channel->clock.AddExact(*grabbed.stream_s)
                                      : channel->clock.Add(grabbed.arrival_s, grabbed.stream_s);
  report.missed = channel->clock.missed();
  if (stamp.sure) {
    pairer->Add(channel->index,
                {std::move(grabbed.grey), stamp.time_s - camera.time_offset_s, grabbed.arrival_s},
                channel->clock.period_s());
  } else {
    ++report.unsure;
  }
  while (auto pictures = pairer->Take()) {
    Queue(std::move(*pictures));
    last_set_s = grabbed.arrival_s;
    silence_told = false;
  }
  WatchSilence(grabbed.arrival_s);
  changed.notify_all();
  return "";
}

// Until the camera is lost: why.
std::string LiveCameras::State::GrabAll(Channel* channel, CameraStream* stream,
                                        Patience* patience) {
  while (!stop) {
    auto grabbed = stream->Grab();
    if (!grabbed) return stream->problem();
    patience->Renew(options.stall_s);
    const std::string wrong = Take(channel, std::move(*grabbed));
    if (!wrong.empty()) return wrong;
  }
  return "";
}

void LiveCameras::State::Lost(Channel* channel, const std::string& problem) {
  const std::lock_guard lock(mutex);
  if (!channel->started) {
    channel->failure = problem;
  } else if (channel->report.state == CameraReport::State::kRunning) {
    messages.push_back(fmt::format("camera \"{}\": lost: {}; opening it again and again",
                                   channel->camera.name, problem));
    channel->lost_s = MonotonicNow();
  }
  channel->report.state = CameraReport::State::kAway;
  channel->arrivals_s.clear();
  channel->clock.Restart();
  pairer->Forget(channel->index);
  changed.notify_all();
}

void LiveCameras::State::Serve(Channel* channel) {
  double pause_s = kFirstPause;
  Patience patience(&stop);
  LiveCamera camera = channel->camera;
  while (!stop) {
    patience.Renew(options.open_timeout_s);
    std::string problem;
    const int64_t before = channel->report.received;  // only this thread changes it
    if (const OpenedStream stream = OpenStream(camera, options, &patience, &problem)) {
      problem = GrabAll(channel, stream.get(), &patience);
    }
    if (stop) return;
    Lost(channel, problem);
    std::unique_lock lock(mutex);
    if (!channel->started) return;  // whoever opens the cameras hears of it
    camera.size = channel->camera.size;
    pause_s = channel->report.received > before ? kFirstPause
                                                : std::min(2 * pause_s, options.longest_pause_s);
    changed.wait_for(lock, std::chrono::duration<double>(pause_s), [&] { return stop.load(); });
  }
}

void LiveCameras::State::Start() {
  for (const LiveCamera& camera : cameras) {
    channels.push_back(
        {channels.size(), camera, {}, StampClock(options.settle_s), {}, NAN, false, "", {}});
    channels.back().report.camera = camera.name;
  }
  for (Channel& channel : channels) {
    channel.thread = std::thread([this, &channel] { Serve(&channel); });
  }
  std::unique_lock lock(mutex);
  const auto is_known = [](const Channel& c) { return c.started || !c.failure.empty(); };
  while (!std::all_of(channels.begin(), channels.end(), is_known)) {
    if (options.stop != nullptr && *options.stop) {  // Next() will give nothing
      stop = true;
      return;
    }
    changed.wait_for(lock, kLook);
  }
  for (size_t c = 0; c < cameras.size(); ++c) {
    const Channel& channel = channels[c];
    if (!channel.started) {
      throw InputError(
          fmt::format("camera \"{}\": {}", channel.camera.name, channel.camera.source),
          "cannot be opened: " + channel.failure,
          "Check that it is connected and not in use, and that the source is written right: "
          "/dev/video0, rtsp://HOST/PATH, http://HOST/PATH, tcp://HOST:PORT, or a GStreamer "
          "pipeline.");
    }
    cameras[c].size = channel.camera.size;
  }
}

void LiveCameras::State::End() {
  {
    const std::lock_guard lock(mutex);
    stop = true;
  }
  changed.notify_all();
  for (Channel& channel : channels) {
    if (channel.thread.joinable()) channel.thread.join();
  }
}

LiveCameras::LiveCameras(std::vector<LiveCamera> cameras, const LiveOptions& options)
    : state_(new State) {
  options.Check();
  CheckCameras(cameras);
  state_->options = options;
  state_->cameras = std::move(cameras);
  state_->pairer =
      std::make_unique<Pairer>(state_->cameras.size(), options.tolerance_s, options.max_wait_s);
  try {
    state_->Start();
  } catch (...) {
    state_->End();
    throw;
  }
}

LiveCameras::~LiveCameras() { state_->End(); }

std::optional<FrameSet> LiveCameras::Next() {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock, [&] { return state_->stop || !state_->queue.empty(); });
  if (state_->stop) return std::nullopt;
  FrameSet set = std::move(state_->queue.front());
  state_->queue.pop_front();
  set.frame = state_->sets++;
  ++state_->delivered;
  return set;
}

void LiveCameras::Stop() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->stop = true;
  }
  state_->changed.notify_all();
}

SourceReport LiveCameras::Report() const {
  const std::lock_guard lock(state_->mutex);
  SourceReport report;
  report.delivered = state_->delivered;
  report.dropped = state_->dropped;
  report.queued = static_cast<int>(state_->queue.size());
  for (size_t c = 0; c < state_->channels.size(); ++c) {
    const Channel& channel = state_->channels[c];
    CameraReport camera = channel.report;
    camera.unpaired = state_->pairer->unpaired(c);
    const auto& arrivals = channel.arrivals_s;
    if (arrivals.size() > 1 && arrivals.back() > arrivals.front()) {
      camera.rate_hz =
          static_cast<double>(arrivals.size() - 1) / (arrivals.back() - arrivals.front());
    }
    report.cameras.push_back(camera);
  }
  return report;
}

std::vector<std::string> LiveCameras::TakeMessages() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->messages, {});
}

const std::vector<LiveCamera>& LiveCameras::cameras() const { return state_->cameras; }

}  // namespace softforce::vision
