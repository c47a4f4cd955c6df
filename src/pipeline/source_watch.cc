#include "pipeline/source_watch.h"

#include <fmt/format.h>

#include <utility>

namespace softforce::pipeline {
namespace {

constexpr std::chrono::milliseconds kInterval(50);
constexpr double kForever = 1e9;     // s; clocks do not count much further
constexpr size_t kMaxMessages = 40;  // that are kept; a bad cable makes thousands

}  // namespace

SourceWatch::SourceWatch(vision::FrameSource* source, const std::atomic<bool>* stop, Tell tell)
    : source_(source), stop_(stop), tell_(std::move(tell)), thread_([this] { Watch(); }) {}

SourceWatch::~SourceWatch() {
  end_ = true;
  thread_.join();
}

void SourceWatch::Watch() {
  while (!end_) {
    if (ShouldStop()) source_->Stop();
    PassOn();
    std::this_thread::sleep_for(kInterval);
  }
  PassOn();
}

bool SourceWatch::ShouldStop() const {
  if (stop_ != nullptr && *stop_) return true;
  const std::lock_guard<std::mutex> lock(mutex_);
  return deadline_ && std::chrono::steady_clock::now() >= *deadline_;
}

void SourceWatch::StopAfter(double seconds) {
  if (seconds > kForever) return;
  const auto time = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
  const std::lock_guard<std::mutex> lock(mutex_);
  deadline_ = std::chrono::steady_clock::now() + time;
}

void SourceWatch::PassOn() {
  for (const std::string& message : source_->TakeMessages()) {
    if (tell_) tell_(message);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (messages_.size() < kMaxMessages) {
      messages_.push_back(message);
    } else {
      ++untold_;
    }
  }
}

std::vector<std::string> SourceWatch::Messages() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> messages = messages_;
  if (untold_ > 0) messages.push_back(fmt::format("{} more messages of the cameras", untold_));
  return messages;
}

}  // namespace softforce::pipeline
