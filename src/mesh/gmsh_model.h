#pragma once

#include <string>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// The tetrahedra of Gmsh's current model, as ReadMesh describes them, with all of the model's
// nodes; lengths in the model's unit. Throws InputError naming `where` if element orders are mixed
// or a volume is in several physical volumes.
TetMesh MeshOfGmshModel(const std::string& where);

}  // namespace softforce::mesh
