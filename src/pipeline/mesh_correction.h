#pragma once

#include <optional>

#include "softforce/pipeline/mesh_convergence.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {

// A body that answers like the mesh of the scene once refined, or like the limit, at the price of
// a mesh refined in a few places.
struct MeshCorrection {
  scene::Scene scene;  // with every Young's modulus times modulus_factor
  mesh::TetMesh mesh;  // the given one, refined locally
  int given_cells = 0;
  MeshBias bias;              // of the given mesh, markers at small loads
  MeshBias left;              // of the local mesh before its modulus is scaled
  double modulus_factor = 1;  // for what the local mesh leaves
  // Model errors were allowed for the given mesh. This share of its bias is still there.
  double model_error_factor = 1;
};

// None for the given mesh. Throws InputError if the refined mesh would be too large, see
// AssessMesh.
std::optional<MeshCorrection> CorrectMesh(const scene::Scene& scene, MeshAim aim,
                                          bool show_progress);

// The body to compute with: the scene's, or the corrected one.
World BuildWorld(const scene::Scene& scene, const std::optional<MeshCorrection>& correction);

// `options` for the given mesh, with model errors as they are for that body.
TrackerOptions Corrected(TrackerOptions options, const std::optional<MeshCorrection>& correction);

}  // namespace softforce::pipeline
