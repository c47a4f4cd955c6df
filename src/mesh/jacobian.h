#pragma once

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

struct JacobianRange {
  double least, greatest;  // m³
};

// Six times the volume per unit of the reference element. In 10-node elements with curved edges it
// differs from place to place: looked at are the 10 nodes and the 4 points of the usual integration
// rule.
JacobianRange JacobianRangeOf(const TetMesh& mesh, int element);

}  // namespace softforce::mesh
