#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softforce/mesh/generate_mesh.h"
#include "softforce/mesh/mesh_report.h"

namespace softforce::mesh {

struct PrepareOptions {
  double metres_per_unit = 1e-3;     // of the input; a STEP file carries its own
  double out_metres_per_unit = NAN;  // of the output; NaN: as the input
  int order = 0;                     // 1 or 2: lower or raise the elements; 0: as they are
  std::vector<std::string> groups;   // see WithSurfaceGroups
  GenerateOptions generate;          // for .stl, .step, .stp, .brep and .geo

  void Check() const;  // throws InputError naming the command's option
};

struct PreparedMesh {
  TetMesh mesh;
  MeshReport report;
  double out_metres_per_unit = 1e-3;  // for WriteMesh
};

// Reads a mesh or generates one from a geometry, names groups of its surface, raises or lowers the
// order, refuses what no simulation can use (CheckMesh), and reports on its quality and on what
// WriteMesh would lose in `out`, if that is not empty. Writes nothing. Throws InputError, also if
// `out` could not be written.
PreparedMesh PrepareMesh(const std::filesystem::path& in, const std::filesystem::path& out,
                         const PrepareOptions& options = {});

}  // namespace softforce::mesh
