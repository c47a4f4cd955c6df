#include "calibration/reprojection_cost.h"

#include <cmath>

namespace softforce::calibration {
namespace {

// J with exp(w + d) = exp(J d) exp(w) to first order in d.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d W = geometry::Skew(w);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6;
  const double square = angle * angle;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / square * W +
         (angle - std::sin(angle)) / (square * angle) * W * W;
}

}  // namespace

Pose ToVector(const Eigen::Isometry3d& T) {
  const Eigen::AngleAxisd turn(T.linear());
  Pose pose;
  pose << turn.angle() * turn.axis(), T.translation();
  return pose;
}

Eigen::Isometry3d ToTransform(const double* pose) {
  const Eigen::Map<const Pose> vector(pose);
  const double angle = vector.head<3>().norm();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = vector.tail<3>();
  if (angle > 0) T.linear() = Eigen::AngleAxisd(angle, vector.head<3>() / angle).matrix();
  return T;
}

ReprojectionCost::ReprojectionCost(const Sighting& sighting, LensFit fit, const BoardShape& board)
    : sighting_(sighting), fit_(fit), board_(board) {
  set_num_residuals(2);
  *mutable_parameter_block_sizes() = {4 + NumDistortion(fit), 6, 6, 2};
}

bool ReprojectionCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const camera::Lens lens = LensFrom(parameters[0], fit_);
  const Eigen::Vector2d warp(parameters[3]);
  const Eigen::Isometry3d T_camera_rig = ToTransform(parameters[1]);
  const Eigen::Isometry3d T_rig_board = ToTransform(parameters[2]);
  const Eigen::Vector3d p_board = board_.Bent(sighting_.id, warp);
  if (jacobians == nullptr) {
    const camera::Projection at = camera::Project(lens, T_camera_rig * (T_rig_board * p_board));
    return at.visible && WriteResidual(at.pixel, residuals);
  }
  const Linearised at =
      Linearise(lens, T_camera_rig, T_rig_board, p_board, board_.basis[sighting_.id]);
  if (!at.visible) return false;
  const int size = 4 + NumDistortion(fit_);
  Write(at.by_lens.leftCols(size), jacobians[0]);
  WritePose(at.by_camera, parameters[1], jacobians[1]);
  WritePose(at.by_board, parameters[2], jacobians[2]);
  Write(at.by_warp, jacobians[3]);
  return WriteResidual(at.pixel, residuals);
}

bool ReprojectionCost::WriteResidual(const Eigen::Vector2d& pixel, double* residuals) const {
  Eigen::Map<Eigen::Vector2d>{residuals} = sighting_.whitening * (pixel - sighting_.pixel);
  return true;
}

template <class Jacobian>
void ReprojectionCost::Write(const Jacobian& by_block, double* jacobian) const {
  if (jacobian == nullptr) return;
  using RowMajor = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(jacobian, 2, by_block.cols()) = sighting_.whitening * by_block;
}

void ReprojectionCost::WritePose(Eigen::Matrix<double, 2, 6> by_pose, const double* pose,
                                 double* jacobian) const {
  if (jacobian == nullptr) return;
  by_pose.leftCols<3>() *= LeftJacobian(Eigen::Vector3d(pose));
  Write(by_pose, jacobian);
}

}  // namespace softforce::calibration
