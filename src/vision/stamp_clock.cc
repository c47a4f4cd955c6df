#include "vision/stamp_clock.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace softforce::vision {
namespace {

// Long enough to hold a picture without jitter, short enough for clocks that drift by 50 ppm.
constexpr double kWindow = 5;  // s
constexpr double kRateWindow =
    20;  // s; its error counts as often as the phase's window has pictures
constexpr size_t kIntervals = 31;
constexpr size_t kLeastPictures = 5;  // before a period is believed
constexpr double kDecideShare = 0.5;  // of the time to settle: late for so long, it is a gap

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void StampClock::Restart() {
  const int64_t missed = missed_;
  *this = StampClock(settle_s_);
  missed_ = missed;
}

void StampClock::CountGap(double since_last_s) {
  if (std::isnan(period_)) return;
  const auto periods = std::llround(since_last_s / period_);
  if (periods > 1) missed_ += periods - 1;
}

void StampClock::LearnPeriod(double time_s) {
  if (!std::isnan(last_time_s_)) {
    CountGap(time_s - last_time_s_);
    intervals_.push_back(time_s - last_time_s_);
    if (intervals_.size() > kIntervals) intervals_.pop_front();
    if (intervals_.size() >= kLeastPictures) {
      period_ = Median({intervals_.begin(), intervals_.end()});
    }
  }
  last_time_s_ = time_s;
}

StampClock::Stamp StampClock::AddExact(double time_s) {
  LearnPeriod(time_s);
  return {time_s, !std::isnan(period_)};
}

StampClock::Stamp StampClock::Add(double arrival_s, std::optional<double> stream_s) {
  if (!stream_s) return AddArrival(arrival_s);
  // The stream began again, or its clock was set: what was learnt is void.
  const double least = least_offset_.empty() ? NAN : least_offset_.front().offset_s;
  if (std::abs(arrival_s - *stream_s - least) > kWindow || *stream_s <= last_time_s_) Restart();
  if (std::isnan(first_arrival_s_)) first_arrival_s_ = arrival_s;
  LearnPeriod(*stream_s);
  const double offset = arrival_s - *stream_s;
  while (!least_offset_.empty() && least_offset_.back().offset_s >= offset) {
    least_offset_.pop_back();
  }
  least_offset_.push_back({arrival_s, offset});
  while (least_offset_.front().arrival_s < arrival_s - kWindow) least_offset_.pop_front();
  const bool sure = arrival_s - first_arrival_s_ >= settle_s_ && !std::isnan(period_);
  return {*stream_s + least_offset_.front().offset_s, sure};
}

double StampClock::PhaseOf(double period) const {
  double phase = std::numeric_limits<double>::infinity();
  for (auto a = arrivals_.rbegin(); a != arrivals_.rend(); ++a) {
    if (a->time_s < arrivals_.back().time_s - kWindow) break;
    phase = std::min(phase, a->time_s - static_cast<double>(a->n) * period);
  }
  return phase;
}

// Least squares over the pictures in time; false if their intervals make no sense.
bool StampClock::LearnRate() {
  double mean_n = 0, mean_t = 0;
  for (const Arrival& a : arrivals_) {
    mean_n += static_cast<double>(a.n - arrivals_.front().n);
    mean_t += a.time_s - arrivals_.front().time_s;
  }
  const auto count = static_cast<double>(arrivals_.size());
  mean_n /= count;
  mean_t /= count;
  double nn = 0, nt = 0;
  for (const Arrival& a : arrivals_) {
    const double n = static_cast<double>(a.n - arrivals_.front().n) - mean_n;
    nn += n * n;
    nt += n * (a.time_s - arrivals_.front().time_s - mean_t);
  }
  if (!(nn > 0 && nt > 0)) return false;
  period_ = nt / nn;
  return true;
}

// All have been late for long enough to say that the camera left some out.
StampClock::Stamp StampClock::DecideLeftOut(double arrival_s) {
  const auto left_out = std::llround(least_lateness_s_ / period_);
  const double rest = least_lateness_s_ - static_cast<double>(left_out) * period_;
  // Not late by whole periods, or late again at once: the camera began anew or changed its rate.
  if (std::abs(rest) > 0.3 * period_ || just_left_out_) {
    Restart();
    return AddArrival(arrival_s);
  }
  just_left_out_ = true;
  last_n_ += left_out;
  missed_ += left_out;
  late_since_s_.reset();
  return {arrival_s, false};
}

// Gathers pictures until their rate can be told.
StampClock::Stamp StampClock::Settle(int64_t n, double arrival_s) {
  if (!arrivals_.empty()) intervals_.push_back(arrival_s - arrivals_.back().time_s);
  arrivals_.push_back({n, arrival_s});
  if (arrival_s - first_arrival_s_ < settle_s_ || arrivals_.size() <= kLeastPictures) {
    return {arrival_s, false};
  }
  period_ = Median({intervals_.begin(), intervals_.end()});
  const double phase = PhaseOf(period_);
  // A burst at the start: late, and of no use for the rate.
  const auto late = [&](const Arrival& a) {
    return a.time_s - phase - static_cast<double>(a.n) * period_ > 0.5 * period_;
  };
  arrivals_.erase(std::remove_if(arrivals_.begin(), arrivals_.end(), late), arrivals_.end());
  settled_ = period_ > 0 && LearnRate();
  if (!settled_) Restart();
  return {arrival_s, false};
}

StampClock::Stamp StampClock::AddArrival(double arrival_s) {
  if (std::isnan(first_arrival_s_)) first_arrival_s_ = arrival_s;
  const int64_t n = last_n_ + 1;
  last_n_ = n;
  if (!settled_) return Settle(n, arrival_s);
  const double expected = PhaseOf(period_) + static_cast<double>(n) * period_;
  const double lateness = arrival_s - expected;
  if (lateness < -0.5 * period_) {  // what was learnt is wrong: learn it again
    Restart();
    return AddArrival(arrival_s);
  }
  if (lateness >= 0.5 * period_) {
    if (!late_since_s_) {
      late_since_s_ = arrival_s;
      least_lateness_s_ = lateness;
    }
    least_lateness_s_ = std::min(least_lateness_s_, lateness);
    if (arrival_s - *late_since_s_ >= kDecideShare * settle_s_) return DecideLeftOut(arrival_s);
    return {arrival_s, false};
  }
  late_since_s_.reset();
  just_left_out_ = false;
  arrivals_.push_back({n, arrival_s});
  while (arrivals_.front().time_s < arrival_s - kRateWindow) arrivals_.pop_front();
  if (arrivals_.size() > kLeastPictures) LearnRate();
  return {PhaseOf(period_) + static_cast<double>(n) * period_, true};
}

}  // namespace softforce::vision
