#pragma once

#include <Eigen/Core>

namespace softforce::vision {

// A filled ellipse in a picture: the points with (p − centre)ᵀ inverse_shape (p − centre) ≤ 1.
class Ellipse {
 public:
  // `shape` (px²) has the squared half axes as its eigenvalues; must be positive definite.
  Ellipse(const Eigen::Vector2d& centre, const Eigen::Matrix2d& shape);

  const Eigen::Vector2d& centre() const { return centre_; }  // px
  double long_half() const { return long_half_; }            // px, half of the long axis
  double short_half() const { return short_half_; }          // px
  // Half width and height of the upright box around it, px.
  Eigen::Vector2d Reach() const { return shape_.diagonal().cwiseSqrt(); }

  // Where a point lies against the contour, to first order; d is relative to the centre.
  struct Place {
    double outside;    // px, distance from the contour, negative inside
    double curvature;  // 1/px, of the contour there
  };
  Place PlaceOf(const Eigen::Vector2d& d) const;
  // `outside` alone.
  double Outside(const Eigen::Vector2d& d) const;

  // The contour's point in a direction (a unit vector) of the ellipse's own measure, relative to
  // the centre.
  Eigen::Vector2d ContourAt(const Eigen::Vector2d& direction) const;

  // Direction from the centre in [0, 1), in the ellipse's own measure: equal steps cut equal areas.
  double SectorOf(const Eigen::Vector2d& d) const;

 private:
  Eigen::Vector2d centre_;
  Eigen::Matrix2d shape_, inverse_shape_, to_circle_, from_circle_;
  double inverse_determinant_;
  double long_half_, short_half_;
};

}  // namespace softforce::vision
