#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "softforce/vision/frame_source.h"

namespace softforce::pipeline {

// Looks after a source of frames on a thread of its own, also while no frames come: stops it when
// that is asked for from outside, and passes on what it has to tell.
class SourceWatch {
 public:
  using Tell = std::function<void(const std::string& message)>;

  // The source and `stop` (none: nothing) must outlive it.
  SourceWatch(vision::FrameSource* source, const std::atomic<bool>* stop, Tell tell);
  ~SourceWatch();
  SourceWatch(const SourceWatch&) = delete;
  SourceWatch& operator=(const SourceWatch&) = delete;

  // Stops the source after so much time from now, s, though no frame comes that says it is over.
  void StopAfter(double seconds);

  // What was told so far; beyond a number of messages, only how many more there were.
  std::vector<std::string> Messages() const;

 private:
  void Watch();
  bool ShouldStop() const;
  void PassOn();

  vision::FrameSource* source_;
  const std::atomic<bool>* stop_;
  const Tell tell_;
  mutable std::mutex mutex_;
  std::optional<std::chrono::steady_clock::time_point> deadline_;
  std::vector<std::string> messages_;
  int untold_ = 0;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace softforce::pipeline
