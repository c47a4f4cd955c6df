#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <utility>

#include "softforce/mesh/surface.h"

namespace softforce::mesh {
namespace {

// Values of the shape functions of a triangle's 3 or 6 nodes.
Eigen::VectorXd Values(int order, const Eigen::Vector3d& L) {
  if (order == 1) return L;
  Eigen::VectorXd N(6);
  N.head<3>() = L.array() * (2 * L.array() - 1);
  N.tail<3>() << 4 * L(0) * L(1), 4 * L(1) * L(2), 4 * L(2) * L(0);
  return N;
}

// Their derivatives (3×2 or 6×2) along L(1) and L(2), while L(0) = 1 − L(1) − L(2).
Eigen::MatrixX2d Derivatives(int order, const Eigen::Vector3d& L) {
  Eigen::MatrixX2d dL(3, 2);
  dL << -1, -1, 1, 0, 0, 1;
  if (order == 1) return dL;
  Eigen::MatrixX2d dN(6, 2);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    dN.row(i) = (4 * L(i) - 1) * dL.row(i);
    dN.row(3 + i) = 4 * (L(i) * dL.row(j) + L(j) * dL.row(i));
  }
  return dN;
}

}  // namespace

Eigen::Vector3d NodalWeights::Apply(const Eigen::Matrix3Xd& field) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) sum += weights[i] * field.col(nodes[i]);
  return sum;
}

NodalWeights ShapeFunctions(const Surface& surface, const SurfacePoint& point) {
  assert(point.triangle >= 0 && point.triangle < surface.num_triangles());
  const Eigen::VectorXd N = Values(surface.order(), point.barycentric);
  std::vector<std::pair<int, double>> entries;
  for (int i = 0; i < N.size(); ++i) {
    entries.emplace_back(surface.triangles(i, point.triangle), N(i));
  }
  std::sort(entries.begin(), entries.end());

  NodalWeights result;
  for (const auto& [node, weight] : entries) {
    result.nodes.push_back(node);
    result.weights.push_back(weight);
  }
  return result;
}

Eigen::Vector3d Position(const Surface& surface, const Eigen::Matrix3Xd& x,
                         const SurfacePoint& point) {
  const Eigen::VectorXd N = Values(surface.order(), point.barycentric);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < N.size(); ++i) sum += N(i) * x.col(surface.triangles(i, point.triangle));
  return sum;
}

Eigen::Vector3d Normal(const Surface& surface, const Eigen::Matrix3Xd& x,
                       const SurfacePoint& point) {
  const Eigen::MatrixX2d dN = Derivatives(surface.order(), point.barycentric);
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = 0; i < dN.rows(); ++i) {
    tangents += x.col(surface.triangles(i, point.triangle)) * dN.row(i);
  }
  return tangents.col(0).cross(tangents.col(1)).normalized();
}

}  // namespace softforce::mesh
