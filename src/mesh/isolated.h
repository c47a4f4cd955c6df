#pragma once

#include <functional>
#include <string>

#include "softforce/mesh/generate_mesh.h"

namespace softforce::mesh {

// Runs `work` in a process of its own and returns its result. CAD libraries crash on some damaged
// files and print on the terminal; there, a crash is an answer and the printing goes nowhere.
// InputErrors of `work` pass through, with `where` in front; a crash becomes one.
GeneratedMesh RunIsolated(const std::string& where, const std::function<GeneratedMesh()>& work);

}  // namespace softforce::mesh
