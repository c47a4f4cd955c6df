#include "vision/rhythm.h"

#include <algorithm>
#include <cmath>

namespace softforce::vision {
namespace {

constexpr double kMost = 0.6;     // of the times must agree
constexpr double kAgree = 0.2;    // of a period
constexpr double kSearch = 0.15;  // of the median interval, to either side

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How many of the times are in one window of the period, and where that begins.
struct Agreement {
  size_t count = 0;
  double begin = 0;  // of a period, 0 to 1
};
Agreement AgreementAt(const std::vector<double>& times_s, double period) {
  std::vector<double> shares;
  for (const double time : times_s) {
    const double periods = (time - times_s.front()) / period;
    shares.push_back(periods - std::floor(periods));
  }
  std::sort(shares.begin(), shares.end());
  const size_t count = shares.size();
  for (size_t i = 0; i < count; ++i) shares.push_back(shares[i] + 1);  // once around
  Agreement best;
  size_t end = 0;
  for (size_t begin = 0; begin < count; ++begin) {
    while (end < shares.size() && shares[end] - shares[begin] <= kAgree) ++end;
    if (end - begin > best.count) best = {end - begin, shares[begin]};
  }
  return best;
}

}  // namespace

std::optional<Rhythm> FindRhythm(const std::vector<double>& times_s) {
  if (times_s.size() < 2) return std::nullopt;
  std::vector<double> intervals;
  for (size_t i = 1; i < times_s.size(); ++i) intervals.push_back(times_s[i] - times_s[i - 1]);
  const double median = Median(intervals);
  if (!(median > 0)) return std::nullopt;
  // From the first to the last, a step moves a picture by a twentieth of a period.
  const double periods = (times_s.back() - times_s.front()) / median;
  const double step = 0.05 / std::max(periods, 1.0);
  Agreement best;
  double best_from = 0, best_to = 0;  // periods that are equally good lie side by side
  for (double change = -kSearch; change <= kSearch; change += step) {
    const double period = median * (1 + change);
    const Agreement agreement = AgreementAt(times_s, period);
    if (agreement.count > best.count) {
      best = agreement;
      best_from = period;
    }
    if (agreement.count == best.count) best_to = period;
  }
  if (static_cast<double>(best.count) < kMost * static_cast<double>(times_s.size())) {
    return std::nullopt;
  }
  const double period = best_to - best_from > 2 * kAgree * median / std::max(periods, 1.0)
                            ? best_from
                            : 0.5 * (best_from + best_to);
  best = AgreementAt(times_s, period);
  return Rhythm{period, times_s.front() + best.begin * period};
}

}  // namespace softforce::vision
