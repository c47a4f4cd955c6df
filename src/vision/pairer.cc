#include "vision/pairer.h"

#include <algorithm>
#include <cmath>

namespace softforce::vision {

Pairer::Pairer(size_t cameras, double tolerance_s, double max_wait_s)
    : asked_tolerance_s_(tolerance_s), max_wait_s_(max_wait_s), cameras_(cameras) {}

double Pairer::tolerance_s() const {
  double tolerance = asked_tolerance_s_;
  for (const Camera& camera : cameras_) {
    if (!std::isnan(camera.period_s)) tolerance = std::min(tolerance, 0.5 * camera.period_s);
  }
  return tolerance;
}

void Pairer::Add(size_t camera, TimedPicture picture, double period_s) {
  Camera& own = cameras_[camera];
  own.period_s = period_s;
  if (!(picture.time_s > own.last_s)) {  // its clock was learnt anew
    ++own.unpaired;
    return;
  }
  own.last_s = picture.time_s;
  const double too_old_s = picture.arrival_s - max_wait_s_;
  own.waiting.push_back(std::move(picture));
  for (Camera& each : cameras_) {
    while (!each.waiting.empty() && each.waiting.front().arrival_s < too_old_s) {
      each.waiting.pop_front();
      ++each.unpaired;
    }
  }
}

void Pairer::Forget(size_t camera) {
  Camera& own = cameras_[camera];
  own.unpaired += static_cast<int64_t>(own.waiting.size());
  own.waiting.clear();
  own.last_s = -INFINITY;
}

std::optional<std::vector<TimedPicture>> Pairer::Take() {
  const double tolerance = tolerance_s();
  while (true) {
    double latest_s = -INFINITY;
    for (const Camera& camera : cameras_) {
      if (camera.waiting.empty()) return std::nullopt;
      latest_s = std::max(latest_s, camera.waiting.front().time_s);
    }
    // Every later picture of that camera is later still: what is too early for this one has no
    // partner.
    bool complete = true;
    for (Camera& camera : cameras_) {
      if (camera.waiting.front().time_s >= latest_s - tolerance) continue;
      camera.waiting.pop_front();
      ++camera.unpaired;
      complete = false;
    }
    if (!complete) continue;
    std::vector<TimedPicture> set;
    for (Camera& camera : cameras_) {
      set.push_back(std::move(camera.waiting.front()));
      camera.waiting.pop_front();
    }
    ++paired_;
    return set;
  }
}

}  // namespace softforce::vision
