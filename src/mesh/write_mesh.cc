#include "softforce/mesh/write_mesh.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "mesh/generate.h"
#include "mesh/writers.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/write_vtu.h"

namespace softforce::mesh {
namespace {

// The number that ReadMesh turns back into x, if there is one: x / unit may be off by a rounding.
double InUnits(double x, double metres_per_unit) {
  const double quotient = x / metres_per_unit;
  for (const double candidate :
       {quotient, std::nextafter(quotient, INFINITY), std::nextafter(quotient, -INFINITY)}) {
    if (candidate * metres_per_unit == x) return candidate;
  }
  return quotient;
}

}  // namespace

void CheckCanWriteMesh(const std::filesystem::path& path) {
  const std::string extension = LowerExtension(path);
  if (extension == ".msh" || extension == ".vtu" || extension == ".vtk") return;
  throw base::InputError(
      path.string(),
      fmt::format("its extension is \"{}\", must be .msh (Gmsh), .vtu or .vtk", extension),
      "Only .msh keeps surface groups and the names of regions.");
}

bool KeepsNames(const std::filesystem::path& path) { return LowerExtension(path) == ".msh"; }

void WriteMesh(const std::filesystem::path& path, const TetMesh& mesh, double metres_per_unit) {
  assert(metres_per_unit > 0);
  CheckCanWriteMesh(path);
  TetMesh scaled = mesh;
  scaled.nodes = mesh.nodes.unaryExpr([&](double x) { return InUnits(x, metres_per_unit); });
  if (LowerExtension(path) == ".msh") {
    WriteGmsh(path, scaled);
  } else if (LowerExtension(path) == ".vtu") {
    WriteVtu(path, scaled);
  } else {
    WriteLegacyVtk(path, scaled);
  }
}

}  // namespace softforce::mesh
