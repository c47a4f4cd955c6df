#include "pipeline/stage_clock.h"

#include <algorithm>
#include <cmath>

namespace softforce::pipeline {

StageClock::Stage& StageClock::Find(const std::string& stage) {
  const auto known = std::find_if(stages_.begin(), stages_.end(),
                                  [&](const Stage& one) { return one.name == stage; });
  if (known != stages_.end()) return *known;
  stages_.push_back({stage, {}, 0, 0, 0});
  return stages_.back();
}

void StageClock::Book(const std::string& stage, double milliseconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Find(stage).times_ms.push_back(static_cast<float>(milliseconds));
}

void StageClock::BookQueue(const std::string& stage, int waiting) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Stage& booked = Find(stage);
  ++booked.taken_up;
  booked.waiting += waiting;
  booked.longest_queue = std::max(booked.longest_queue, waiting);
}

std::vector<StageTimes> StageClock::Report(size_t newest) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<StageTimes> report;
  for (const Stage& stage : stages_) {
    StageTimes times;
    times.stage = stage.name;
    times.count = static_cast<int>(stage.times_ms.size());
    times.queued = stage.taken_up > 0;
    if (times.queued) {
      times.queue_mean = static_cast<double>(stage.waiting) / static_cast<double>(stage.taken_up);
    }
    times.queue_max = stage.longest_queue;
    const size_t count = std::min(newest, stage.times_ms.size());
    std::vector<float> sorted(stage.times_ms.end() - static_cast<std::ptrdiff_t>(count),
                              stage.times_ms.end());
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) -> double {
      if (sorted.empty()) return 0;
      const auto last = static_cast<double>(sorted.size() - 1);
      return sorted[static_cast<size_t>(std::lround(share * last))];
    };
    times.median_ms = at(0.5);
    times.p90_ms = at(0.9);
    times.p95_ms = at(0.95);
    times.p99_ms = at(0.99);
    times.max_ms = at(1);
    for (const float ms : sorted) times.total_s += 1e-3 * ms;
    report.push_back(times);
  }
  return report;
}

}  // namespace softforce::pipeline
