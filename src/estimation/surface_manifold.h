#pragma once

#include <ceres/manifold.h>

#include "softforce/mesh/surface_walk.h"

namespace softforce::estimation {

// A surface point as Ceres holds it: the number of its triangle, then barycentric coordinates.
void Pack(const mesh::SurfacePoint& point, double* ambient);
mesh::SurfacePoint Unpack(const double* ambient);

// Moves a surface point by walking over the surface: two steps (m) along the tangents of its
// triangle.
class SurfaceManifold : public ceres::Manifold {
 public:
  static constexpr int kAmbient = 4;
  static constexpr int kTangent = 2;

  // `walk` must outlive this.
  explicit SurfaceManifold(const mesh::SurfaceWalk* walk) : walk_(walk) {}

  int AmbientSize() const override { return kAmbient; }
  int TangentSize() const override { return kTangent; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  // The straight way between two points, along the tangents at the first.
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

 private:
  const mesh::SurfaceWalk* walk_;
};

// A derivative by the two steps (rows×2) as one by the ambient coordinates (rows×4), such that
// Ceres, which multiplies by PlusJacobian, has the former again: that Jacobian is constant, the
// first two coordinates' identity.
Eigen::MatrixXd AmbientJacobian(const Eigen::MatrixXd& by_steps);

}  // namespace softforce::estimation
