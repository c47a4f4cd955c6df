#pragma once

#include <Eigen/Core>
#include <optional>

#include "softforce/mesh/surface.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// The shape functions at a place inside the body at rest; nothing if no element contains it. For
// order 2 elements are taken as if their edges were straight.
std::optional<NodalWeights> InteriorPoint(const TetMesh& mesh, const Eigen::Vector3d& place);

}  // namespace softforce::mesh
