#include "estimation/surface_manifold.h"

namespace softforce::estimation {
namespace {

using JacobianMap = Eigen::Map<Eigen::Matrix<double, 4, 2, Eigen::RowMajor>>;
using InverseMap = Eigen::Map<Eigen::Matrix<double, 2, 4, Eigen::RowMajor>>;

}  // namespace

void Pack(const mesh::SurfacePoint& point, double* ambient) {
  ambient[0] = point.triangle;
  Eigen::Map<Eigen::Vector3d>{ambient + 1} = point.barycentric;
}

mesh::SurfacePoint Unpack(const double* ambient) {
  return {static_cast<int>(ambient[0]), Eigen::Map<const Eigen::Vector3d>(ambient + 1)};
}

bool SurfaceManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const mesh::SurfacePoint from = Unpack(x);
  const Eigen::Vector3d step =
      walk_->Tangents(from.triangle) * Eigen::Map<const Eigen::Vector2d>(delta);
  Pack(walk_->Step(from, step), x_plus_delta);
  return true;
}

// The ambient coordinates have no derivatives of use (the triangle's number jumps): any matrix of
// rank 2 serves that AmbientJacobian undoes.
bool SurfaceManifold::PlusJacobian(const double* /*x*/, double* jacobian) const {
  JacobianMap(jacobian).setIdentity();
  return true;
}

bool SurfaceManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const mesh::SurfacePoint from = Unpack(x);
  const Eigen::Vector3d way = walk_->Position(Unpack(y)) - walk_->Position(from);
  Eigen::Map<Eigen::Vector2d>{y_minus_x} = walk_->Tangents(from.triangle).transpose() * way;
  return true;
}

bool SurfaceManifold::MinusJacobian(const double* /*x*/, double* jacobian) const {
  InverseMap(jacobian).setIdentity();
  return true;
}

Eigen::MatrixXd AmbientJacobian(const Eigen::MatrixXd& by_steps) {
  Eigen::MatrixXd ambient = Eigen::MatrixXd::Zero(by_steps.rows(), SurfaceManifold::kAmbient);
  ambient.leftCols(SurfaceManifold::kTangent) = by_steps;
  return ambient;
}

}  // namespace softforce::estimation
