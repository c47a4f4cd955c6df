#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace softforce::vision {

// A picture and when it was taken, on the clock that all cameras share.
struct TimedPicture {
  cv::Mat grey;
  double time_s = NAN;
  double arrival_s = NAN;
};

// Puts the pictures of all cameras together that were taken within a tolerance of each other, each
// picture at most once. What has no partner in each other camera is counted and left out.
class Pairer {
 public:
  Pairer(size_t cameras, double tolerance_s, double max_wait_s);

  // Times of one camera must ascend; one that does not counts as unpaired. `period_s`: between the
  // camera's pictures; the tolerance is at most half of the shortest.
  void Add(size_t camera, TimedPicture picture, double period_s);

  // A camera begins anew: what waits of it has no partners, and its times may be any.
  void Forget(size_t camera);

  // The next complete set, one picture per camera, if there is one.
  std::optional<std::vector<TimedPicture>> Take();

  double tolerance_s() const;  // that is in force
  size_t waiting(size_t camera) const { return cameras_[camera].waiting.size(); }
  int64_t unpaired(size_t camera) const { return cameras_[camera].unpaired; }
  int64_t paired() const { return paired_; }

 private:
  struct Camera {
    std::deque<TimedPicture> waiting;
    double last_s = -INFINITY;
    double period_s = NAN;
    int64_t unpaired = 0;
  };

  double asked_tolerance_s_, max_wait_s_;
  std::vector<Camera> cameras_;
  int64_t paired_ = 0;
};

}  // namespace softforce::vision
