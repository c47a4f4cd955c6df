#pragma once

#include <Eigen/Core>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

struct Overlap {
  int cells = 0;                                 // whose centre lies within a cell of another part
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // m, of the first
};

// Finds where parts of a mesh that share no node fill the same space.
Overlap FindOverlap(const TetMesh& mesh);

}  // namespace softforce::mesh
