#pragma once

#include <vector>

#include "softforce/mesh/surface.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {

// The nodes of a mesh of the scene's body that its section "fixed" holds, ascending; `surface` is
// that of the mesh. Throws InputError for a region that holds none, or a group that is not there.
std::vector<int> FixedNodes(const Scene& scene, const mesh::TetMesh& mesh,
                            const mesh::Surface& surface);

}  // namespace softforce::scene
