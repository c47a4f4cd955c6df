#include <algorithm>
#include <cmath>

#include "camera/lens_models.h"

namespace softforce::camera::kannala_brandt {
namespace {

double Radius(const Lens& lens, double theta) {
  const auto& k = lens.distortion;
  const double t = theta * theta;
  return theta * (1 + t * (k[0] + t * (k[1] + t * (k[2] + t * k[3]))));
}

double Slope(const Lens& lens, double theta) {
  const auto& k = lens.distortion;
  const double t = theta * theta;
  return 1 + t * (3 * k[0] + t * (5 * k[1] + t * (7 * k[2] + t * 9 * k[3])));
}

// The radius must have grown all the way from the axis: beyond the calibrated field the polynomial
// may turn back, and even rise once more.
bool WithinField(const Lens& lens, double theta) {
  constexpr double kStep = 0.05;  // rad
  if (!(theta < M_PI && Slope(lens, theta) > 0)) return false;
  for (double on_the_way = kStep; on_the_way < theta; on_the_way += kStep) {
    if (!(Slope(lens, on_the_way) > 0)) return false;
  }
  return true;
}

}  // namespace

Distorted Distort(const Lens& lens, const Eigen::Vector3d& p_camera) {
  Distorted distorted;
  const Eigen::Vector2d xy = p_camera.head<2>();
  const double z = p_camera.z();
  const double rho = xy.norm();
  const double square = p_camera.squaredNorm();
  if (!(square > 0)) return distorted;
  const double theta = std::atan2(rho, z);
  if (!WithinField(lens, theta)) return distorted;

  distorted.within_field = true;
  if (rho < 1e-9 * z) {  // on the axis, where the direction xy / rho is not defined
    distorted.point = xy / z;
    distorted.jacobian << 1 / z, 0, -xy.x() / (z * z), 0, 1 / z, -xy.y() / (z * z);
    return distorted;
  }
  const Eigen::Vector2d outward = xy / rho;
  const double radius = Radius(lens, theta);
  const double slope = Slope(lens, theta);
  distorted.point = radius * outward;
  // Along `outward` by the angle's change, across it by the turn of the direction.
  const Eigen::Matrix2d along = outward * outward.transpose();
  distorted.jacobian.leftCols<2>() =
      slope * z / square * along + radius / rho * (Eigen::Matrix2d::Identity() - along);
  distorted.jacobian.col(2) = -slope * rho / square * outward;
  return distorted;
}

DistortionJacobian ByDistortion(const Lens& /*lens*/, const Eigen::Vector3d& p_camera) {
  DistortionJacobian jacobian = DistortionJacobian::Zero();
  const double rho = p_camera.head<2>().norm();
  if (!(rho > 0)) return jacobian;
  const Eigen::Vector2d outward = p_camera.head<2>() / rho;
  const double theta = std::atan2(rho, p_camera.z());
  double power = theta;
  for (int i = 0; i < NumDistortion(LensModel::kKannalaBrandt); ++i) {
    power *= theta * theta;
    jacobian.col(i) = power * outward;
  }
  return jacobian;
}

std::optional<Eigen::Vector3d> Undistort(const Lens& lens, const Eigen::Vector2d& point) {
  const double goal = point.norm();
  if (goal == 0) return Eigen::Vector3d::UnitZ();
  // Newton from the equidistant lens, kept within a bracket: the radius grows as long as it can be
  // seen, so that a bracket that holds the answer keeps it.
  double low = 0;
  double high = M_PI;
  double theta = std::min(goal, 0.5 * M_PI);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const bool beyond = !WithinField(lens, theta) || Radius(lens, theta) > goal;
    (beyond ? high : low) = theta;
    const double newton = theta - (Radius(lens, theta) - goal) / Slope(lens, theta);
    const double next = newton >= low && newton <= high ? newton : 0.5 * (low + high);
    const bool settled = std::abs(next - theta) < 1e-12 * (1 + theta);
    theta = next;
    if (settled) break;
  }
  if (!(std::abs(Radius(lens, theta) - goal) < 1e-9 && WithinField(lens, theta))) {
    return std::nullopt;
  }
  const Eigen::Vector2d sideways = std::sin(theta) / goal * point;
  return Eigen::Vector3d(sideways.x(), sideways.y(), std::cos(theta));
}

}  // namespace softforce::camera::kannala_brandt
