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
constexpr double kDrift = 100e-6;  // by which clocks of cameras and computers differ at most
constexpr double kJump = 30;       // s; no picture is so late
constexpr size_t kIntervals = 31;
constexpr size_t kLeastPictures = 5;  // before a period is believed
constexpr double kPatience = 3;  // s without a picture that is sure, before a new rhythm is tried
// Shares of a period:
constexpr double kEarly = 0.15;       // that a picture may come before the earliest so far
constexpr double kFarTooEarly = 0.5;  // for that to be explained by jitter
constexpr double kInTime = 0.4;       // after the earliest, for a picture to learn the rhythm from
constexpr double kAtOnce = 0.1;       // after the earliest, for a picture that waited nowhere
constexpr double kSamePeriod = 0.03;
constexpr double kNear = 0.25;  // of the smallest difference: half of what pairing can bear
constexpr int kSupport = 4;     // pictures near it, for it to be believed
constexpr int kInRhythm = 6;    // pictures in time, one period apart: nothing waits any more
constexpr int64_t kAnyNumber = std::numeric_limits<int64_t>::min() / 2;

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

void StampClock::LearnPeriod(double time_s) {
  if (!std::isnan(last_time_s_)) {
    const double interval = time_s - last_time_s_;
    if (!std::isnan(period_)) missed_ += std::max<int64_t>(0, std::llround(interval / period_) - 1);
    intervals_.push_back(interval);
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
  const double offset = arrival_s - *stream_s;
  // The stream began again, or its clock was set: what was learnt is void.
  if (std::abs(offset - least_offset_s_) > kJump || *stream_s <= last_time_s_) Restart();
  if (std::isnan(first_arrival_s_)) {
    first_arrival_s_ = arrival_s;
    least_offset_s_ = offset;
  }
  if (!std::isnan(last_time_s_)) least_offset_s_ += kDrift * (*stream_s - last_time_s_);
  LearnPeriod(*stream_s);
  // One that stands alone may still be late: a busy computer delays all for a while.
  const double near = kNear * period_;
  if (offset < least_offset_s_ - near) support_ = 0;
  least_offset_s_ = std::min(least_offset_s_, offset);
  if (offset < least_offset_s_ + near) ++support_;
  const bool sure = arrival_s - first_arrival_s_ >= settle_s_ && support_ >= kSupport;
  return {*stream_s + least_offset_s_, sure};
}

// The rhythm of the last pictures, if they have one.
std::optional<Rhythm> StampClock::RecentRhythm() const {
  if (recent_s_.size() <= kLeastPictures) return std::nullopt;
  return FindRhythm({recent_s_.begin(), recent_s_.end()});
}

// Takes up a rhythm. Which picture is which is still to be told.
void StampClock::Settle(const Rhythm& rhythm) {
  settled_ = true;
  period_ = rhythm.period_s;
  phase_ = rhythm.phase_s;
  arrivals_.clear();
  int64_t last_n = kAnyNumber;
  for (const double time_s : recent_s_) {
    const double periods = (time_s - phase_) / period_;
    const auto n = static_cast<int64_t>(std::floor(periods + kEarly));
    if (periods - static_cast<double>(n) < kInTime && n > last_n) InTime(last_n = n, time_s);
  }
  least_n_ = kAnyNumber;
  in_rhythm_ = 0;
  last_early_s_ = recent_s_.back();
}

// The line through the pictures in time: its slope by least squares, then as early as the earliest.
void StampClock::InTime(int64_t n, double arrival_s) {
  arrivals_.push_back({n, arrival_s});
  while (arrivals_.front().time_s < arrival_s - kRateWindow) arrivals_.pop_front();
  const auto count = static_cast<double>(arrivals_.size());
  const Arrival origin = arrivals_.front();
  double mean_n = 0, mean_t = 0;
  for (const Arrival& a : arrivals_) {
    mean_n += static_cast<double>(a.n - origin.n) / count;
    mean_t += (a.time_s - origin.time_s) / count;
  }
  double nn = 0, nt = 0;
  for (const Arrival& a : arrivals_) {
    const double from_mean = static_cast<double>(a.n - origin.n) - mean_n;
    nn += from_mean * from_mean;
    nt += from_mean * (a.time_s - origin.time_s - mean_t);
  }
  if (arrivals_.size() > kLeastPictures && nt > 0) period_ = nt / nn;
  phase_ = std::numeric_limits<double>::infinity();
  for (auto a = arrivals_.rbegin(); a != arrivals_.rend(); ++a) {
    if (a->time_s < arrival_s - kWindow) break;
    phase_ = std::min(phase_, a->time_s - static_cast<double>(a->n) * period_);
  }
}

StampClock::Stamp StampClock::AddArrival(double arrival_s) {
  if (std::isnan(first_arrival_s_)) first_arrival_s_ = last_sure_s_ = arrival_s;
  const double since_last_s = recent_s_.empty() ? NAN : arrival_s - recent_s_.back();
  recent_s_.push_back(arrival_s);
  while (recent_s_.front() < arrival_s - 2 * settle_s_) recent_s_.pop_front();
  const bool look =
      !settled_ ? arrival_s - first_arrival_s_ >= settle_s_ : arrival_s - last_sure_s_ >= kPatience;
  if (look) {
    const auto rhythm = RecentRhythm();
    if (rhythm && !(std::abs(rhythm->period_s - period_) < kSamePeriod * period_)) Settle(*rhythm);
    last_sure_s_ = arrival_s;  // not to look at every picture
  }
  if (!settled_) return {arrival_s, false};
  // A rhythm in which hardly any picture comes is none.
  if (arrival_s - last_early_s_ > settle_s_) {
    settled_ = false;
    period_ = NAN;
    return {arrival_s, false};
  }

  const double periods = (arrival_s - phase_) / period_;
  auto most_n = static_cast<int64_t>(std::floor(periods + kEarly));
  ++least_n_;
  if (most_n < least_n_) {  // before it can have been taken
    const bool wrong = static_cast<double>(least_n_) - periods > kFarTooEarly;
    if (wrong) least_n_ = kAnyNumber;  // a number before was
    if (!wrong) most_n = least_n_;     // all so far came late
  }
  const double lateness = periods - static_cast<double>(most_n);
  if (lateness < kEarly) last_early_s_ = arrival_s;
  const bool in_rhythm = lateness < kAtOnce && std::abs(since_last_s - period_) < kAtOnce * period_;
  in_rhythm_ = in_rhythm ? in_rhythm_ + 1 : 0;
  if (most_n > least_n_ && in_rhythm_ >= kInRhythm) {
    if (least_n_ > kAnyNumber / 2) missed_ += most_n - least_n_;
    least_n_ = most_n;
  }
  if (most_n > least_n_) return {arrival_s, false};
  last_sure_s_ = arrival_s;
  if (lateness < kInTime) InTime(most_n, arrival_s);
  return {phase_ + static_cast<double>(most_n) * period_, true};
}

}  // namespace softforce::vision
