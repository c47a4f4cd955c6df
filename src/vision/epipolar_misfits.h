#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/time_offset.h"
#include "vision/track_interpolation.h"

namespace softforce::vision {

// By how much markers that two cameras see at one moment are off each other's epipolar lines, if
// the second camera's stamps are late by an offset. Rig, tracks and options must outlive it.
class EpipolarMisfits {
 public:
  EpipolarMisfits(const camera::Camera& first, const camera::Camera& second,
                  const std::vector<TrackPair>& tracks, const TimeOffsetOptions& options);

  // Normal equation of one Gauss-Newton step, the mean truncated misfit, and what noise does; what
  // errors of the rig explain is taken off.
  struct Sum {
    double cost = 0, normal = 0, right = 0, squares = 0;
    // What noise of 1 px makes of `squares` and `normal`, and the variance of `right`.
    double noise_squares = 0, noise_normal = 0, variance = 0;
    double right_squares = 0;  // of the tracks' shares in `right`
    int seen = 0, used = 0, tracks = 0;
    std::vector<double> misfits;  // px, of all seen
    double mean_cost() const { return cost / seen; }
  };
  Sum Evaluate(double offset_s) const;

  // Misfits beyond 5 standard deviations are no noise; told from the median of all.
  void TightenLimit(double offset_s);

 private:
  // The epipolar form x2ᵀ E x1 of two undistorted points, and its gradient by their pixels.
  struct Form {
    double value;
    Eigen::Vector2d by_first, by_second;  // 1/px
  };

  // A picture of a marker: how far the first camera's is from the epipolar line of the other's.
  struct Misfit {
    double px, slope;  // px, px/s
    double along;      // px, where the second camera sees it, in the direction of the misfit
    Form form;
    double scale;  // px of a unit of the form
    Interpolated at;
  };

  std::optional<Form> Epipolar(const Eigen::Vector2d& first, const Eigen::Vector2d& second) const;
  std::vector<Misfit> MisfitsOf(const TrackPair& track, double offset_s) const;
  static int TakeOffWhatTheRigMayBeWrongBy(std::vector<Misfit>* track);
  void Add(const TrackPair& track, const std::vector<Misfit>& misfits, Sum* sum) const;

  const camera::Camera& first_;
  const camera::Camera& second_;
  const std::vector<TrackPair>& tracks_;
  const TimeOffsetOptions& options_;
  Eigen::Matrix3d E_;
  double limit_px_;  // misfits beyond do not count
};

}  // namespace softforce::vision
