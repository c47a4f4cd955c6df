#include "vision/ellipse.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cassert>
#include <cmath>

namespace softforce::vision {

Ellipse::Ellipse(const Eigen::Vector2d& centre, const Eigen::Matrix2d& shape)
    : centre_(centre), shape_(shape), inverse_shape_(shape.inverse()) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(shape);
  assert(axes.eigenvalues()(0) > 0);
  to_circle_ = axes.operatorInverseSqrt();
  from_circle_ = axes.operatorSqrt();
  inverse_determinant_ = inverse_shape_.determinant();
  short_half_ = std::sqrt(axes.eigenvalues()(0));
  long_half_ = std::sqrt(axes.eigenvalues()(1));
}

double Ellipse::Outside(const Eigen::Vector2d& d) const {
  const Eigen::Vector2d normal = inverse_shape_ * d;
  const double radius2 = d.dot(normal);  // 1 on the contour
  if (!(radius2 > 1e-12)) return -short_half_;
  // The radius less 1, over the slope of the radius across the contour, |normal| / radius.
  return (radius2 - std::sqrt(radius2)) / normal.norm();
}

Ellipse::Place Ellipse::PlaceOf(const Eigen::Vector2d& d) const {
  const Eigen::Vector2d normal = inverse_shape_ * d;
  const double radius2 = d.dot(normal);
  if (!(radius2 > 1e-12)) return {-short_half_, 1 / short_half_};
  const double slope = normal.norm() / std::sqrt(radius2);  // 1/px
  // The curvature of xᵀQx = 1 is |Q| / |Qx|³, taken where the ray through d meets the contour.
  return {Outside(d), inverse_determinant_ / (slope * slope * slope)};
}

Eigen::Vector2d Ellipse::ContourAt(const Eigen::Vector2d& direction) const {
  return from_circle_ * direction;
}

double Ellipse::SectorOf(const Eigen::Vector2d& d) const {
  const Eigen::Vector2d on_circle = to_circle_ * d;
  const double turn = std::atan2(on_circle.y(), on_circle.x()) / (2 * M_PI);
  return turn < 0 ? turn + 1 : turn;
}

}  // namespace softforce::vision
