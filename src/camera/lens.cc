#include "softforce/camera/lens.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace softforce::camera {
namespace {

struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;  // d point / d undistorted
};

// OpenCV's rational model: radial factor (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶),
// plus the tangential terms p1, p2.
Distorted Distort(const BrownConrady& lens, const Eigen::Vector2d& n) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = lens.distortion;
  const double x = n.x();
  const double y = n.y();
  const double r2 = n.squaredNorm();
  const double numerator = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double denominator = 1 + r2 * (k4 + r2 * (k5 + r2 * k6));
  const double radial = numerator / denominator;
  const double d_numerator = k1 + r2 * (2 * k2 + r2 * 3 * k3);  // d/d(r²)
  const double d_denominator = k4 + r2 * (2 * k5 + r2 * 3 * k6);
  const double d_radial = (d_numerator - radial * d_denominator) / denominator;

  Distorted d;
  d.point << x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
      y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  d.jacobian << radial + 2 * x * x * d_radial + 2 * p1 * y + 6 * p2 * x,
      2 * x * y * d_radial + 2 * p1 * x + 2 * p2 * y,
      2 * x * y * d_radial + 2 * p1 * x + 2 * p2 * y,
      radial + 2 * y * y * d_radial + 6 * p1 * y + 2 * p2 * x;
  return d;
}

// Beyond the radius where the distorted radius stops growing the polynomial folds back, and a point
// far outside the field would be drawn inside the picture.
bool WithinField(const Distorted& d) {
  return d.jacobian.determinant() > 0 && d.jacobian.trace() > 0;
}

}  // namespace

Projection Project(const BrownConrady& lens, const Eigen::Vector3d& p_camera) {
  Projection projection;
  const double z = p_camera.z();
  if (!(z > 0)) return projection;
  const Eigen::Vector2d n = p_camera.head<2>() / z;
  const Distorted d = Distort(lens, n);
  if (!WithinField(d) || !d.point.allFinite()) return projection;

  const Eigen::Vector2d f(lens.fx, lens.fy);
  Eigen::Matrix<double, 2, 3> d_n;  // of the normalised coordinates by p_camera
  d_n << 1 / z, 0, -n.x() / z, 0, 1 / z, -n.y() / z;
  projection.pixel = f.cwiseProduct(d.point) + Eigen::Vector2d(lens.cx, lens.cy);
  projection.jacobian = f.asDiagonal() * d.jacobian * d_n;
  projection.visible = true;
  return projection;
}

std::optional<Eigen::Vector2d> Unproject(const BrownConrady& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d goal((pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy);
  Eigen::Vector2d n = goal;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Distorted d = Distort(lens, n);
    const Eigen::Vector2d misfit = goal - d.point;
    if (misfit.norm() < 1e-14 * (1 + goal.norm())) break;
    const Eigen::Vector2d step = d.jacobian.inverse() * misfit;
    if (!step.allFinite()) return std::nullopt;
    n += step;
    if (step.norm() < 1e-15 * (1 + n.norm())) break;
  }
  const Distorted d = Distort(lens, n);
  const bool found = (d.point - goal).norm() < 1e-9 && WithinField(d);
  return found ? std::optional<Eigen::Vector2d>(n) : std::nullopt;
}

std::optional<Eigen::Vector2d> ProjectDiscCentroid(const BrownConrady& lens,
                                                   const Eigen::Vector3d& centre_camera,
                                                   const Eigen::Vector3d& normal_camera,
                                                   double diameter) {
  const Eigen::Vector3d e1 = normal_camera.unitOrthogonal();
  const Eigen::Vector3d e2 = normal_camera.normalized().cross(e1);
  // The mean of the projection over the picture's area: a rule over the disc that is exact for
  // polynomials of degree 5 (six points on one circle and the centre), each point weighted by how
  // much picture its surroundings cover.
  constexpr int kPoints = 6;
  const double ring = diameter / 2 * std::sqrt(2.0 / 3.0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * M_PI * i / kPoints;
    const bool centre = i == kPoints;
    const Eigen::Vector3d offset =
        centre ? Eigen::Vector3d(Eigen::Vector3d::Zero())
               : Eigen::Vector3d(ring * (std::cos(angle) * e1 + std::sin(angle) * e2));
    const Projection at = Project(lens, centre_camera + offset);
    if (!at.visible) return std::nullopt;
    Eigen::Matrix2d d_pixel;  // by the disc's own two coordinates
    d_pixel << at.jacobian * e1, at.jacobian * e2;
    const double weight = (centre ? 1.0 / 4 : 1.0 / 8) * std::abs(d_pixel.determinant());
    sum += weight * at.pixel;
    area += weight;
  }
  if (!(area > 0)) return std::nullopt;  // seen exactly from the side
  return sum / area;
}

}  // namespace softforce::camera
