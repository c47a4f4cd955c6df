#include "pipeline/frame_rate.h"

#include <algorithm>

namespace softforce::pipeline {
namespace {

constexpr std::chrono::seconds kSpan{2};
constexpr double kShortest = 1e-3;  // s

}  // namespace

void FrameRate::Add(Clock::time_point arrival) {
  arrivals_.push_back(arrival);
  while (arrival - arrivals_.front() > kSpan) arrivals_.pop_front();
}

double FrameRate::PerSecond(Clock::time_point now) const {
  const auto since = std::find_if(arrivals_.begin(), arrivals_.end(),
                                  [&](Clock::time_point one) { return now - one <= kSpan; });
  const auto count = arrivals_.end() - since;
  if (count < 2) return 0;
  const double span_s = std::chrono::duration<double>(now - *since).count();
  return static_cast<double>(count) / std::max(span_s, kShortest);
}

}  // namespace softforce::pipeline
