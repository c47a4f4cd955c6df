#pragma once

#include <ceres/cost_function.h>

#include "calibration/estimate.h"

namespace softforce::calibration {

// A transform as Ceres has it: rotation vector (rad), translation (m).
using Pose = Eigen::Matrix<double, 6, 1>;
Pose ToVector(const Eigen::Isometry3d& T);
Eigen::Isometry3d ToTransform(const double* pose);

// The whitened reprojection error of one sighting. Blocks: lens, T_camera_rig, T_rig_board, warp.
// Sighting and board must outlive it.
class ReprojectionCost : public ceres::CostFunction {
 public:
  ReprojectionCost(const Sighting& sighting, LensFit fit, const BoardShape& board);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  bool WriteResidual(const Eigen::Vector2d& pixel, double* residuals) const;
  void WritePose(Eigen::Matrix<double, 2, 6> by_pose, const double* pose, double* jacobian) const;

  template <class Jacobian>
  void Write(const Jacobian& by_block, double* jacobian) const;

  const Sighting& sighting_;
  LensFit fit_;
  const BoardShape& board_;
};

}  // namespace softforce::calibration
