#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// Both functions keep the order, the regions, the surface groups and the shape: a middle node of a
// 10-node cell becomes a corner where its edge is cut, and new middle nodes lie on the parent's
// curved edges and faces. The result is conforming (neighbours share whole faces) and
// deterministic; its nodes are numbered anew.

// A mesh cut finer, and of each cell: the cell of the coarse mesh that it is a part of, and its
// corners there, as columns of barycentric coordinates.
struct Refinement {
  TetMesh mesh;
  std::vector<int> parent;
  std::vector<std::array<Eigen::Vector4d, 4>> corners;
};

// Cuts every cell into 8: one at each corner, and the octahedron that remains into 4 around the
// shortest of its three diagonals, which keeps the shapes best.
Refinement Refine(const TetMesh& mesh);

// Cuts the edges of the marked cells (a flag per cell) in half, and as many of their neighbours'
// as keep the mesh conforming: a cell with a cut edge has its longest edge cut too, so that shapes
// do not degrade when this is repeated (Plaza and Carey 2000). A marked cell gives 8, others 1
// to 8.
Refinement RefineWhere(const TetMesh& mesh, const std::vector<char>& marked);

}  // namespace softforce::mesh
