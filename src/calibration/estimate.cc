#include "calibration/estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace softforce::calibration {

BoardShape MakeBoardShape(const std::vector<Eigen::Vector3d>& points) {
  BoardShape board;
  board.points = points;
  Eigen::Vector2d low = points.front().head<2>();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  // A bend shows only in points between the first and the last of either axis.
  std::array<bool, 2> between = {false, false};
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Array2d s = (p.head<2>() - low).array() / (high - low).array();
    const Eigen::Array2d bend = 4 * s * (1 - s);
    board.basis.push_back(bend.matrix());
    for (int i = 0; i < 2; ++i) between[i] = between[i] || bend[i] > 0.1;
  }
  board.can_bend = between[0] && between[1];
  if (!board.can_bend) board.basis.assign(points.size(), Eigen::Vector2d::Zero());
  return board;
}

Eigen::VectorXd LensVector(const camera::Lens& lens, LensFit fit) {
  Eigen::VectorXd parameters(4 + NumDistortion(fit));
  parameters.head<4>() << lens.fx, lens.fy, lens.cx, lens.cy;
  for (int i = 0; i < NumDistortion(fit); ++i) parameters(4 + i) = lens.distortion[i];
  return parameters;
}

camera::Lens LensFrom(const double* parameters, LensFit fit) {
  camera::Lens lens;
  lens.fx = parameters[0];
  lens.fy = parameters[1];
  lens.cx = parameters[2];
  lens.cy = parameters[3];
  std::copy_n(parameters + 4, NumDistortion(fit), lens.distortion.begin());
  lens.model = ModelOf(fit);
  return lens;
}

double PriorSd(LensFit fit, int parameter) {
  const bool radial = parameter >= 4 && parameter != 6 && parameter != 7;  // not p1, p2
  return fit == LensFit::kBrownConrady8 && radial ? 5 : std::numeric_limits<double>::infinity();
}

Linearised Linearise(const camera::Lens& lens, const Eigen::Isometry3d& T_camera_rig,
                     const Eigen::Isometry3d& T_rig_board, const Eigen::Vector3d& p_board,
                     const Eigen::Vector2d& bend_basis) {
  Linearised linearised;
  const Eigen::Matrix3d R_camera_rig = T_camera_rig.linear();
  const Eigen::Vector3d turned_board = T_rig_board.linear() * p_board;
  const Eigen::Vector3d turned_rig = R_camera_rig * (turned_board + T_rig_board.translation());
  const Eigen::Vector3d p_camera = turned_rig + T_camera_rig.translation();
  const camera::Projection at = camera::Project(lens, p_camera);
  linearised.visible = at.visible;
  if (!at.visible) return linearised;

  linearised.pixel = at.pixel;
  linearised.by_lens = camera::ProjectionByLens(lens, p_camera);
  linearised.by_camera.leftCols<3>() = -at.jacobian * geometry::Skew(turned_rig);
  linearised.by_camera.rightCols<3>() = at.jacobian;
  const Eigen::Matrix<double, 2, 3> by_rig = at.jacobian * R_camera_rig;
  linearised.by_board.leftCols<3>() = -by_rig * geometry::Skew(turned_board);
  linearised.by_board.rightCols<3>() = by_rig;
  linearised.by_warp = by_rig * T_rig_board.linear().col(2) * bend_basis.transpose();
  return linearised;
}

Eigen::Isometry3d Moved(const Eigen::Isometry3d& T, const geometry::Vector6d& change) {
  Eigen::Isometry3d moved = T;
  const double angle = change.head<3>().norm();
  if (angle > 0) {
    moved.linear() = Eigen::AngleAxisd(angle, change.head<3>() / angle) * T.linear();
  }
  moved.translation() += change.tail<3>();
  return moved;
}

double WhitenedError(const BoardShape& board, const Estimate& estimate, const Sighting& sighting) {
  const camera::Projection at = camera::Project(
      estimate.lenses[sighting.camera],
      estimate.T_camera_rig[sighting.camera] *
          (estimate.T_rig_board[sighting.view] * board.Bent(sighting.id, estimate.warp)));
  if (!at.visible) return std::numeric_limits<double>::infinity();
  return (sighting.whitening * (sighting.pixel - at.pixel)).norm();
}

void SetFloor(double floor_px, std::vector<Sighting>* sightings) {
  for (Sighting& sighting : *sightings) {
    const Eigen::Matrix2d covariance =
        sighting.covariance + floor_px * floor_px * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d L = covariance.llt().matrixL();
    sighting.whitening = L.inverse();
  }
}

double RobustNoise(const BoardShape& board, const Estimate& estimate,
                   const std::vector<Sighting>& sightings) {
  std::vector<double> errors;
  for (const Sighting& sighting : sightings) {
    errors.push_back(WhitenedError(board, estimate, sighting));
  }
  if (errors.empty()) return NAN;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle / std::sqrt(2 * std::log(2.0));  // the median of Rayleigh's distribution
}

double RobustFloor(const BoardShape& board, const Estimate& estimate,
                   std::vector<Sighting> sightings) {
  const auto noise_with = [&](double floor_px) {
    SetFloor(floor_px, &sightings);
    return RobustNoise(board, estimate, sightings);
  };
  if (!(noise_with(0) > 1)) return 0;
  double low = 0;
  double high = 1e-3;  // px
  while (noise_with(high) > 1 && high < 1e3) high *= 2;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (noise_with(middle) > 1 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace softforce::calibration
