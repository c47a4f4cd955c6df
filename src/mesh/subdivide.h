#pragma once

#include <array>
#include <functional>
#include <vector>

#include "softforce/mesh/refine.h"

namespace softforce::mesh {

// Corners of a part of a cell, as numbers of the cell's ten nodes.
using Part = std::array<int, 4>;
using PartsOf = std::function<std::vector<Part>(int element)>;

// Builds the mesh of the parts of all cells. `raised` is `mesh` with 10-node cells, whose middle
// nodes become corners where parts name them; neighbours must cut their common face alike.
Refinement Subdivide(const TetMesh& mesh, const TetMesh& raised, const PartsOf& parts_of);

}  // namespace softforce::mesh
