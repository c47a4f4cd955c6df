#include "mesh/tetrahedron.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

double VolumeOf(const Eigen::Matrix<double, 3, 4>& corners) {
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = corners.col(i + 1) - corners.col(0);
  return edges.determinant() / 6;
}

TetrahedronShape ShapeOf(const Eigen::Matrix<double, 3, 4>& corners) {
  double squares = 0;
  for (const auto& [a, b] : kEdges) squares += (corners.col(a) - corners.col(b)).squaredNorm();
  const double volume = std::max(0.0, VolumeOf(corners));
  TetrahedronShape shape{12 * std::cbrt(9 * volume * volume) / squares, INFINITY, 0};

  Eigen::Matrix<double, 3, 4> normals;  // of the face opposite to each corner, outward
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d a = corners.col(kFaces[i][0]);
    const Eigen::Vector3d b = corners.col(kFaces[i][1]);
    const Eigen::Vector3d c = corners.col(kFaces[i][2]);
    normals.col(i) = (b - a).cross(c - a).normalized();
  }
  for (const auto& [a, b] : kEdges) {
    const double cosine = std::clamp(-normals.col(a).dot(normals.col(b)), -1.0, 1.0);
    const double angle = std::acos(cosine);
    shape.least_dihedral = std::min(shape.least_dihedral, angle);
    shape.greatest_dihedral = std::max(shape.greatest_dihedral, angle);
  }
  return shape;
}

}  // namespace softforce::mesh
