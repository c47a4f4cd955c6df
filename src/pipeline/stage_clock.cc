#include "pipeline/stage_clock.h"

#include <algorithm>
#include <cmath>

namespace softforce::pipeline {

void StageClock::Book(const std::string& stage, double milliseconds) {
  for (auto& [name, times] : times_ms_) {
    if (name != stage) continue;
    times.push_back(milliseconds);
    return;
  }
  times_ms_.push_back({stage, {milliseconds}});
}

std::vector<StageClock::Percentiles> StageClock::Report() const {
  std::vector<Percentiles> report;
  for (auto [name, times] : times_ms_) {
    std::sort(times.begin(), times.end());
    const auto at = [&times = times](double share) {
      return times[static_cast<size_t>(std::lround(share * static_cast<double>(times.size() - 1)))];
    };
    report.push_back(
        {name, static_cast<int>(times.size()), at(0.5), at(0.9), at(0.95), at(0.99), times.back()});
  }
  return report;
}

}  // namespace softforce::pipeline
