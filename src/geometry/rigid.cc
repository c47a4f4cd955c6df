#include "softforce/geometry/rigid.h"

#include <cmath>

namespace softforce::geometry {

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Eigen::Isometry3d ExpSe3(const Vector6d& xi) {
  const Eigen::Vector3d rho = xi.head<3>();
  const Eigen::Vector3d phi = xi.tail<3>();
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Eigen::Matrix3d S = Skew(phi);
  // sin(a)/a, (1 − cos a)/a², (a − sin a)/a³, by their series where the quotients lose digits.
  const bool small = angle < 1e-4;
  const double s1 = small ? 1 - angle2 / 6 : std::sin(angle) / angle;
  const double s2 = small ? 0.5 - angle2 / 24 : (1 - std::cos(angle)) / angle2;
  const double s3 = small ? 1.0 / 6 - angle2 / 120 : (angle - std::sin(angle)) / (angle2 * angle);

  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Matrix3d::Identity() + s1 * S + s2 * S * S;
  T.translation() = rho + s2 * (S * rho) + s3 * (S * (S * rho));
  return T;
}

double RotationDefect(const Eigen::Matrix3d& R) {
  if (!(R.determinant() > 0)) return 2;
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

}  // namespace softforce::geometry
