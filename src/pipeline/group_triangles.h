#pragma once

#include <string>
#include <vector>

#include "softforce/mesh/surface.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::pipeline {

// The triangles of the surface, by index, that a named group of the mesh is made of. Throws
// InputError naming `where` if the mesh has no such group.
std::vector<int> GroupTriangles(const std::string& group, const mesh::TetMesh& mesh,
                                const mesh::Surface& surface, const std::string& where);

}  // namespace softforce::pipeline
