#include "softforce/mesh/interior_point.h"

#include <Eigen/LU>
#include <algorithm>

#include "softforce/mesh/tet_shapes.h"

namespace softforce::mesh {
namespace {

NodalWeights ShapeFunctionsOf(const TetMesh& mesh, int element, const Eigen::Vector4d& b) {
  const Eigen::VectorXd value = TetShapes(mesh.order(), b);
  std::vector<std::pair<int, double>> sorted;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    sorted.emplace_back(mesh.elements(i, element), value(i));
  }
  std::sort(sorted.begin(), sorted.end());
  NodalWeights weights;
  for (const auto& [node, weight] : sorted) {
    weights.nodes.push_back(node);
    weights.weights.push_back(weight);
  }
  return weights;
}

}  // namespace

std::optional<NodalWeights> InteriorPoint(const TetMesh& mesh, const Eigen::Vector3d& place) {
  constexpr double kRounding = 1e-12;  // of the barycentric coordinates, on a common face
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const Eigen::Vector3d origin = mesh.nodes.col(mesh.elements(0, e));
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = mesh.nodes.col(mesh.elements(i + 1, e)) - origin;
    Eigen::Vector4d b;
    b.tail<3>() = edges.inverse() * (place - origin);
    b(0) = 1 - b.tail<3>().sum();
    if (b.minCoeff() >= -kRounding) return ShapeFunctionsOf(mesh, e, b);
  }
  return std::nullopt;
}

}  // namespace softforce::mesh
