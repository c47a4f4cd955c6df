#include "mesh/jacobian.h"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

namespace softforce::mesh {
namespace {

// Barycentric coordinates of the nodes and of the integration points.
std::vector<Eigen::Vector4d> Places() {
  std::vector<Eigen::Vector4d> places;
  for (int corner = 0; corner < 4; ++corner) places.push_back(Eigen::Vector4d::Unit(corner));
  for (const auto& [a, b] : kEdges) {
    places.push_back((Eigen::Vector4d::Unit(a) + Eigen::Vector4d::Unit(b)) / 2);
  }
  constexpr double kNear = 0.5854101966249685;  // (5 + 3 √5) / 20: the 4-point rule of degree 2
  for (int corner = 0; corner < 4; ++corner) {
    Eigen::Vector4d place = Eigen::Vector4d::Constant((1 - kNear) / 3);
    place(corner) = kNear;
    places.push_back(place);
  }
  return places;
}

double Determinant(const Eigen::Matrix<double, 3, 4>& dx) {
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) J.col(i) = dx.col(i + 1) - dx.col(0);
  return J.determinant();
}

}  // namespace

JacobianRange JacobianRangeOf(const TetMesh& mesh, int element) {
  const auto node = [&](int i) -> Eigen::Vector3d {
    return mesh.nodes.col(mesh.elements(i, element));
  };
  Eigen::Matrix<double, 3, 4> dx;  // along each barycentric coordinate
  if (mesh.order() == 1) {
    for (int i = 0; i < 4; ++i) dx.col(i) = node(i);
    const double determinant = Determinant(dx);
    return {determinant, determinant};
  }
  static const std::vector<Eigen::Vector4d> kPlaces = Places();
  JacobianRange range{INFINITY, -INFINITY};
  for (const Eigen::Vector4d& L : kPlaces) {
    for (int i = 0; i < 4; ++i) dx.col(i) = (4 * L(i) - 1) * node(i);
    for (int i = 0; i < 6; ++i) {
      const auto [a, b] = kEdges[i];
      dx.col(a) += 4 * L(b) * node(4 + i);
      dx.col(b) += 4 * L(a) * node(4 + i);
    }
    const double determinant = Determinant(dx);
    range.least = std::min(range.least, determinant);
    range.greatest = std::max(range.greatest, determinant);
  }
  return range;
}

}  // namespace softforce::mesh
