#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "camera/lens_models.h"

namespace softforce::camera::brown_conrady {
namespace {

// The radial factor (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶).
struct Radial {
  double r2, factor, denominator;
  double slope;  // d factor / d r²
};

Radial RadialFactor(const Lens& lens, const Eigen::Vector2d& n) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = lens.distortion;
  Radial radial;
  const double r2 = radial.r2 = n.squaredNorm();
  const double numerator = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  radial.denominator = 1 + r2 * (k4 + r2 * (k5 + r2 * k6));
  radial.factor = numerator / radial.denominator;
  const double d_numerator = k1 + r2 * (2 * k2 + r2 * 3 * k3);
  const double d_denominator = k4 + r2 * (2 * k5 + r2 * 3 * k6);
  radial.slope = (d_numerator - radial.factor * d_denominator) / radial.denominator;
  return radial;
}

struct OnPlane {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;  // d point / d n

  // Beyond the radius where the distorted radius stops growing the polynomial folds back, and a
  // point far outside the field would be drawn inside the picture.
  bool WithinField() const {
    return jacobian.determinant() > 0 && jacobian.trace() > 0 && point.allFinite();
  }
};

OnPlane DistortOnPlane(const Lens& lens, const Eigen::Vector2d& n) {
  const double p1 = lens.distortion[2];
  const double p2 = lens.distortion[3];
  const double x = n.x();
  const double y = n.y();
  const auto [r2, factor, denominator, slope] = RadialFactor(lens, n);

  OnPlane d;
  d.point << x * factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
      y * factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  d.jacobian << factor + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x,
      2 * x * y * slope + 2 * p1 * x + 2 * p2 * y,  //
      2 * x * y * slope + 2 * p1 * x + 2 * p2 * y,
      factor + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return d;
}

}  // namespace

Distorted Distort(const Lens& lens, const Eigen::Vector3d& p_camera) {
  Distorted distorted;
  const double z = p_camera.z();
  if (!(z > 0)) return distorted;
  const Eigen::Vector2d n = p_camera.head<2>() / z;
  const OnPlane d = DistortOnPlane(lens, n);
  if (!d.WithinField()) return distorted;

  Eigen::Matrix<double, 2, 3> d_n;  // of the normalised coordinates by p_camera
  d_n << 1 / z, 0, -n.x() / z, 0, 1 / z, -n.y() / z;
  distorted.point = d.point;
  distorted.jacobian = d.jacobian * d_n;
  distorted.within_field = true;
  return distorted;
}

DistortionJacobian ByDistortion(const Lens& lens, const Eigen::Vector3d& p_camera) {
  const Eigen::Vector2d n = p_camera.head<2>() / p_camera.z();
  const auto [r2, factor, denominator, slope] = RadialFactor(lens, n);
  const double xy2 = 2 * n.x() * n.y();
  const Eigen::Vector2d k1 = n * r2 / denominator;
  const Eigen::Vector2d k4 = -factor * k1;
  DistortionJacobian jacobian;
  jacobian << k1, k1 * r2, Eigen::Vector2d(xy2, r2 + 2 * n.y() * n.y()),
      Eigen::Vector2d(r2 + 2 * n.x() * n.x(), xy2), k1 * r2 * r2, k4, k4 * r2, k4 * r2 * r2;
  return jacobian;
}

std::optional<Eigen::Vector3d> Undistort(const Lens& lens, const Eigen::Vector2d& point) {
  Eigen::Vector2d n = point;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const OnPlane d = DistortOnPlane(lens, n);
    const Eigen::Vector2d misfit = point - d.point;
    if (misfit.norm() < 1e-14 * (1 + point.norm())) break;
    const Eigen::Vector2d step = d.jacobian.inverse() * misfit;
    if (!step.allFinite()) return std::nullopt;
    n += step;
    if (step.norm() < 1e-15 * (1 + n.norm())) break;
  }
  const OnPlane d = DistortOnPlane(lens, n);
  if (!((d.point - point).norm() < 1e-9 && d.WithinField())) return std::nullopt;
  return n.homogeneous();
}

}  // namespace softforce::camera::brown_conrady
