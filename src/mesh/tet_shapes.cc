#include "softforce/mesh/tet_shapes.h"

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

Eigen::VectorXd TetShapes(int order, const Eigen::Vector4d& at) {
  if (order == 1) return at;
  Eigen::VectorXd shapes(10);
  for (int i = 0; i < 4; ++i) shapes(i) = at(i) * (2 * at(i) - 1);
  for (int i = 0; i < 6; ++i) shapes(4 + i) = 4 * at(kEdges[i][0]) * at(kEdges[i][1]);
  return shapes;
}

Eigen::MatrixX4d TetShapeDerivatives(int order, const Eigen::Vector4d& at) {
  if (order == 1) return Eigen::Matrix4d::Identity();
  Eigen::MatrixX4d derivatives = Eigen::MatrixX4d::Zero(10, 4);
  for (int i = 0; i < 4; ++i) derivatives(i, i) = 4 * at(i) - 1;
  for (int i = 0; i < 6; ++i) {
    const auto [a, b] = kEdges[i];
    derivatives(4 + i, a) = 4 * at(b);
    derivatives(4 + i, b) = 4 * at(a);
  }
  return derivatives;
}

}  // namespace softforce::mesh
