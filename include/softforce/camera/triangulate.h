#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/camera/rig.h"

namespace softforce::camera {

// One point in one camera of a rig.
struct PixelObservation {
  int camera = -1;
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(NAN);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(NAN);  // px²
};

struct TriangulationOptions {
  double min_parallax = 0.02;  // rad, the widest angle between two of the viewing rays
  // The misfit's χ² may be as large as this probability allows for right data.
  double consistency_probability = 0.9999;
  int max_iterations = 20;

  void Check() const;  // throws InputError naming the option
};

struct Triangulation {
  enum class Status { kNotRun, kOk, kTooFewCameras, kLowParallax, kBehindCamera, kInconsistent };

  Status status = Status::kNotRun;
  Eigen::Vector3d p_rig = Eigen::Vector3d::Constant(NAN);       // m; set unless kTooFewCameras
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(NAN);  // m²
  double chi2 = NAN;  // whitened squared reprojection error, of 2·cameras − 3 degrees of freedom

  bool ok() const { return status == Status::kOk; }
};

// Finds one point from its distorted pixels in two or more cameras, as the maximum-likelihood point
// for pixel noise of the given covariances (Gauss–Newton on the reprojection error, from the rays'
// closest point). Poor geometry is an answer, not an error: read `status`.
Triangulation Triangulate(const Rig& rig, const std::vector<PixelObservation>& pixels,
                          const TriangulationOptions& options = {});

}  // namespace softforce::camera
