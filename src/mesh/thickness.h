#pragma once

#include <Eigen/Core>

#include "softforce/mesh/surface.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// How many cells lie between opposite walls of a body. From the middle of every triangle of the
// surface a ray runs inward; where it leaves through a wall that faces the other way (by more than
// 120 degrees), the cells across are the edges on the shortest way from one wall's triangle to the
// other's. Shares are of the area of the surface that has such a wall.
struct Thickness {
  double one_cell = 0, two_cells = 0, more_cells = 0;  // add up to 1, or are all 0
  double thinnest = INFINITY;                          // m, the shortest of these rays
  Eigen::Vector3d thinnest_at = Eigen::Vector3d::Zero();
};

Thickness MeasureThickness(const TetMesh& mesh, const Surface& surface);

}  // namespace softforce::mesh
