#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <utility>

#include "mesh/triangle_shapes.h"
#include "softforce/mesh/surface.h"

namespace softforce::mesh {
Eigen::Vector3d NodalWeights::Apply(const Eigen::Matrix3Xd& field) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) sum += weights[i] * field.col(nodes[i]);
  return sum;
}

NodalWeights ShapeFunctions(const Surface& surface, const SurfacePoint& point) {
  assert(point.triangle >= 0 && point.triangle < surface.num_triangles());
  const TriangleValues N = TriangleShapes(surface.order(), point.barycentric);
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

Eigen::MatrixXd ShapeFunctionSlopes(const Surface& surface, const Eigen::Matrix3Xd& X,
                                    const SurfacePoint& point, const Eigen::Matrix3Xd& directions) {
  const auto corner = [&](int i) { return X.col(surface.triangles(i, point.triangle)); };
  const Eigen::Vector3d edge1 = corner(1) - corner(0), edge2 = corner(2) - corner(0);
  const Eigen::MatrixXd slopes = TriangleShapeSlopes(surface.order(), point.barycentric) *
                                 (BarycentricSlopes(edge1, edge2) * directions);

  std::vector<std::pair<int, int>> order;  // as ShapeFunctions
  for (int i = 0; i < slopes.rows(); ++i) {
    order.emplace_back(surface.triangles(i, point.triangle), i);
  }
  std::sort(order.begin(), order.end());
  Eigen::MatrixXd sorted(slopes.rows(), slopes.cols());
  for (int i = 0; i < slopes.rows(); ++i) sorted.row(i) = slopes.row(order[i].second);
  return sorted;
}

Eigen::Vector3d Position(const Surface& surface, const Eigen::Matrix3Xd& x,
                         const SurfacePoint& point) {
  const TriangleValues N = TriangleShapes(surface.order(), point.barycentric);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < N.size(); ++i) sum += N(i) * x.col(surface.triangles(i, point.triangle));
  return sum;
}

Eigen::Vector3d Normal(const Surface& surface, const Eigen::Matrix3Xd& x,
                       const SurfacePoint& point) {
  const TriangleSlopes dN = TriangleShapeSlopes(surface.order(), point.barycentric);
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = 0; i < dN.rows(); ++i) {
    tangents += x.col(surface.triangles(i, point.triangle)) * dN.row(i);
  }
  return tangents.col(0).cross(tangents.col(1)).normalized();
}

}  // namespace softforce::mesh
