#pragma once

#include <Eigen/Core>

namespace softforce::mesh {

// A value, or a derivative along each of two coordinates, per node of a triangle.
using TriangleValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using TriangleSlopes = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 6, 2>;

// Shape functions of a triangle's 3 or 6 nodes at barycentric coordinates L.
inline TriangleValues TriangleShapes(int order, const Eigen::Vector3d& L) {
  if (order == 1) return L;
  TriangleValues N(6);
  N.head<3>() = L.array() * (2 * L.array() - 1);
  N.tail<3>() << 4 * L(0) * L(1), 4 * L(1) * L(2), 4 * L(2) * L(0);
  return N;
}

// Their derivatives (3×2 or 6×2) along L(1) and L(2), while L(0) = 1 − L(1) − L(2).
inline TriangleSlopes TriangleShapeSlopes(int order, const Eigen::Vector3d& L) {
  TriangleSlopes dL(3, 2);
  dL << -1, -1, 1, 0, 0, 1;
  if (order == 1) return dL;
  TriangleSlopes dN(6, 2);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    dN.row(i) = (4 * L(i) - 1) * dL.row(i);
    dN.row(3 + i) = 4 * (L(i) * dL.row(j) + L(j) * dL.row(i));
  }
  return dN;
}

// Derivatives of L(1) and L(2) by the place, of a flat triangle: the dual basis of its edges from
// corner 0 (2×3, 1/m).
inline Eigen::Matrix<double, 2, 3> BarycentricSlopes(const Eigen::Vector3d& edge1,
                                                     const Eigen::Vector3d& edge2) {
  const Eigen::Vector3d n = edge1.cross(edge2);
  Eigen::Matrix<double, 2, 3> dL;
  dL << edge2.cross(n).transpose(), n.cross(edge1).transpose();
  return dL / n.squaredNorm();
}

}  // namespace softforce::mesh
