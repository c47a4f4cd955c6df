#pragma once

#include <Eigen/Core>

namespace softforce::mesh {

// How good a tetrahedron is, by its corners alone.
struct TetrahedronShape {
  // 12 (3V)^(2/3) / Σ l², the mean ratio: 1 for the regular tetrahedron, 0 for a flat one; of the
  // same shape at any size.
  double quality;
  double least_dihedral, greatest_dihedral;  // rad, between two faces
};

// `corners`: a tetrahedron's, one per column.
TetrahedronShape ShapeOf(const Eigen::Matrix<double, 3, 4>& corners);

double VolumeOf(const Eigen::Matrix<double, 3, 4>& corners);

}  // namespace softforce::mesh
