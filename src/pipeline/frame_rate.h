#pragma once

#include <chrono>
#include <deque>

namespace softforce::pipeline {

// How many frames came per second of late. Of a run that stands still it falls to 0.
class FrameRate {
 public:
  using Clock = std::chrono::steady_clock;

  void Add(Clock::time_point arrival);
  double PerSecond(Clock::time_point now) const;

 private:
  std::deque<Clock::time_point> arrivals_;  // of late
};

}  // namespace softforce::pipeline
