#pragma once

#include <string>
#include <vector>

#include "softforce/mesh/mesh_report.h"

namespace softforce::mesh {

// What the user of a mesh should know, with what can be done about it.
std::vector<std::string> WarningsOf(const MeshReport& report);

}  // namespace softforce::mesh
