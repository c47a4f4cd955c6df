#pragma once

#include <filesystem>

#include "softforce/validation/model.h"

namespace softforce::validation {

// The meshes that a body of the study is computed on, all with 10-node cells. Forces found on one
// of them from the answer of another carry the difference of the two discretisations.
struct Discretisations {
  mesh::TetMesh given;    // the mesh of the project, about as many cells as the paper's
  mesh::TetMesh inverse;  // finer, cut by Gmsh on its own and refined where stress is singular
  // Every cell of the given one cut into 8, those where stress is singular once more: without that
  // the markers beside the robot's feet would see its discretisation.
  mesh::TetMesh truth;
};

// Reads sheet.msh or robot.msh, and cuts sheet.geo or robot.geo beside it anew. Throws InputError
// if a file is missing.
Discretisations MakeDiscretisations(BodyKind body, const std::filesystem::path& meshes);

// The cells where stress is singular cut in half: those at the edges of what is held, and at
// re-entrant edges of the surface.
mesh::TetMesh RefineAtEdges(BodyKind body, const mesh::TetMesh& mesh);

}  // namespace softforce::validation
