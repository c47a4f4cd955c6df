#include "calibration/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace softforce::calibration {
namespace {

std::vector<double> FromEdgeToEdge(int pixels, int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back((pixels - 1.0) * i / (count - 1));
  return places;
}

Dependence ProjectionDependence(const NormalEquations& equations, const Estimate& estimate,
                                int camera, const Eigen::Vector3d& p_camera) {
  const camera::Lens& lens = estimate.lenses[camera];
  const Eigen::Isometry3d& T_camera_rig = estimate.T_camera_rig[camera];
  const Eigen::Vector3d p_rig = T_camera_rig.inverse() * p_camera;
  const Eigen::Matrix<double, 2, 3> by_camera_point = camera::Project(lens, p_camera).jacobian;
  const Eigen::Matrix<double, 2, 3> by_rig_point = by_camera_point * T_camera_rig.linear();

  Dependence dependence;
  dependence.by_shared = Eigen::MatrixXd::Zero(2, equations.num_shared());
  const int num_lens = estimate.num_lens(camera);
  dependence.by_shared.middleCols(equations.lens_start(camera), num_lens) =
      camera::ProjectionByLens(lens, p_camera).leftCols(num_lens);
  if (const int start = equations.pose_start(camera); start >= 0) {
    dependence.by_shared.middleCols<3>(start) =
        -by_camera_point * geometry::Skew(T_camera_rig.linear() * p_rig);
    dependence.by_shared.middleCols<3>(start + 3) = by_camera_point;
  }
  const double share = 1.0 / equations.num_boards();
  for (size_t v = 0; v < estimate.T_rig_board.size(); ++v) {
    dependence.by_board.emplace_back();
    if (!equations.has_board(static_cast<int>(v))) continue;
    Eigen::Matrix<double, 2, 6> by_board;
    by_board << -by_rig_point * geometry::Skew(p_rig - estimate.T_rig_board[v].translation()),
        by_rig_point;
    dependence.by_board.back() = share * by_board;
  }
  return dependence;
}

}  // namespace

ProjectionUncertainty ProjectionUncertaintyOf(const NormalEquations& equations,
                                              const Estimate& estimate, double noise_factor,
                                              const CameraToCalibrate& size, int camera,
                                              double distance, int columns, int rows) {
  ProjectionUncertainty uncertainty;
  uncertainty.distance = distance;
  uncertainty.x = FromEdgeToEdge(size.width, columns);
  uncertainty.y = FromEdgeToEdge(size.height, rows);
  uncertainty.sd_px = Eigen::MatrixXd::Constant(rows, columns, NAN);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      uncertainty.covariances.push_back(Eigen::Matrix2d::Constant(NAN));
      const auto ray =
          camera::UnprojectRay(estimate.lenses[camera], {uncertainty.x[c], uncertainty.y[r]});
      if (!ray) continue;
      const Eigen::Matrix2d covariance = noise_factor * noise_factor *
                                         equations.CovarianceOf(ProjectionDependence(
                                             equations, estimate, camera, distance * *ray));
      uncertainty.covariances.back() = covariance;
      uncertainty.sd_px(r, c) =
          std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()(1));
    }
  }
  return uncertainty;
}

}  // namespace softforce::calibration
