#include "softforce/mesh/prepare_mesh.h"

#include <fmt/format.h>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/mesh/read_mesh.h"
#include "softforce/mesh/surface_groups.h"
#include "softforce/mesh/write_mesh.h"

namespace softforce::mesh {
namespace {

using base::InputError;

GeneratedMesh ReadOrGenerate(const std::filesystem::path& in, const PrepareOptions& options) {
  if (IsGeometryFile(in)) return GenerateMesh(in, options.metres_per_unit, options.generate);
  if (!std::isnan(options.generate.size)) {
    throw InputError("--size", fmt::format("{} is not a geometry that can be meshed", in.string()),
                     "Give the .stl, .step, .brep or .geo file that the mesh was made from.");
  }
  return {ReadMesh(in, options.metres_per_unit), NAN, {}};
}

// Region names that are integers come back as they were.
bool IsNumber(const std::string& name) {
  const std::size_t start = name.rfind('-', 0) == 0 ? 1 : 0;
  return name.size() > start && name.find_first_not_of("0123456789", start) == std::string::npos;
}

void WarnOfLosses(const std::filesystem::path& out, const TetMesh& mesh, MeshReport* report) {
  if (KeepsNames(out)) return;
  if (!mesh.surface_groups.empty()) {
    report->warnings.push_back(
        fmt::format("{} keeps no surface groups. Write .msh if a scene needs them.", out.string()));
  }
  std::vector<std::string> lost;
  for (const std::string& name : mesh.region_names) {
    if (!name.empty() && !IsNumber(name)) lost.push_back(name);
  }
  if (lost.empty()) return;
  report->warnings.push_back(
      fmt::format("{} keeps numbers of regions only, not the names \"{}\". Write .msh if a scene "
                  "gives them materials.",
                  out.string(), fmt::join(lost, "\", \"")));
}

}  // namespace

void PrepareOptions::Check() const {
  if (order < 0 || order > 2) {
    throw InputError("--order", fmt::format("got {}, must be 1 or 2", order),
                     "1: tetrahedra of 4 nodes; 2: of 10 nodes.");
  }
  generate.Check();
}

PreparedMesh PrepareMesh(const std::filesystem::path& in, const std::filesystem::path& out,
                         const PrepareOptions& options) {
  options.Check();
  if (!out.empty()) {
    CheckCanWriteMesh(out);
    base::CheckCanWrite(out);
  }
  auto [mesh, solid_volume, warnings] = ReadOrGenerate(in, options);
  CheckMesh(mesh, in.string());
  mesh = WithSurfaceGroups(std::move(mesh), options.groups, in.string());
  if (options.order != 0) mesh = WithOrder(mesh, options.order);
  CheckMesh(mesh, in.string());  // a curved element may be sound and its corners not

  MeshReport report = ExamineMesh(mesh, solid_volume);
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  if (!out.empty()) WarnOfLosses(out, mesh, &report);
  const double in_unit = CarriesItsUnit(in) ? 1e-3 : options.metres_per_unit;
  const double out_unit =
      std::isnan(options.out_metres_per_unit) ? in_unit : options.out_metres_per_unit;
  return {std::move(mesh), std::move(report), out_unit};
}

}  // namespace softforce::mesh
