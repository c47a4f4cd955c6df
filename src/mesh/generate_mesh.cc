#include "softforce/mesh/generate_mesh.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

#include "mesh/generate.h"
#include "mesh/gmsh_model.h"
#include "mesh/gmsh_session.h"
#include "mesh/isolated.h"
#include "mesh/tetrahedron.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

// Their numbers in the script or file, with their names where they have one.
std::vector<std::string> UngroupedVolumes() {
  std::vector<std::string> volumes;
  gmsh::vectorpair solids;
  gmsh::model::getEntities(solids, 3);
  for (const auto& [dimension, tag] : solids) {
    std::vector<int> groups;
    gmsh::model::getPhysicalGroupsForEntity(dimension, tag, groups);
    if (!groups.empty()) continue;
    std::string name;
    gmsh::model::getEntityName(dimension, tag, name);
    volumes.push_back(name.empty() ? fmt::format("{}", tag) : fmt::format("{} \"{}\"", tag, name));
  }
  return volumes;
}

// Gmsh meshes the volumes without a physical group as well; its own program leaves those out of the
// file, and so do we. If no volume is in a group, all stay.
void DropUngroupedVolumes(GeneratedMesh& generated) {
  TetMesh& mesh = generated.mesh;
  const auto unnamed = std::find(mesh.region_names.begin(), mesh.region_names.end(), "");
  if (unnamed == mesh.region_names.end() || mesh.region_names.size() == 1) return;
  const int dropped = static_cast<int>(unnamed - mesh.region_names.begin());
  int kept = 0;
  double volume = 0, dropped_volume = 0;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const int region = mesh.region[e];
    Eigen::Matrix<double, 3, 4> corners;
    for (int i = 0; i < 4; ++i) corners.col(i) = mesh.nodes.col(mesh.elements(i, e));
    volume += VolumeOf(corners);
    if (region == dropped) dropped_volume += VolumeOf(corners);
    if (region == dropped) continue;
    mesh.elements.col(kept) = mesh.elements.col(e).eval();
    mesh.region[kept++] = region - (region > dropped);
  }
  mesh.elements.conservativeResize(Eigen::NoChange, kept);
  mesh.region.resize(kept);
  mesh.region_names.erase(unnamed);
  generated.warnings.push_back(fmt::format(
      "left out, as in no physical group while others are: volume {}, {:.1f} % of the whole. Add "
      "it to a Physical Volume if it belongs to the body.",
      fmt::join(UngroupedVolumes(), ", "), 100 * dropped_volume / volume));
}

// Gmsh's optimiser leaves nodes behind that no element uses; a script may mesh surfaces of no
// volume.
void DropUnusedNodes(TetMesh& mesh) {
  std::vector<int> number(mesh.num_nodes(), -1);
  for (const int node : mesh.elements.reshaped()) number[node] = 0;
  int kept = 0;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (number[node] < 0) continue;
    mesh.nodes.col(kept) = mesh.nodes.col(node).eval();
    number[node] = kept++;
  }
  mesh.nodes.conservativeResize(3, kept);
  for (int& node : mesh.elements.reshaped()) node = number[node];
  for (auto& [name, triangles] : mesh.surface_groups) {
    std::vector<std::array<int, 3>> renumbered;
    for (std::array<int, 3> triangle : triangles) {
      for (int& node : triangle) node = number[node];
      if (*std::min_element(triangle.begin(), triangle.end()) >= 0) renumbered.push_back(triangle);
    }
    triangles = renumbered;
  }
}

double Load(const std::filesystem::path& path, double size, const GenerateOptions& options) {
  if (LowerExtension(path) == ".stl") return LoadStl(path, size, options.feature_angle);
  if (LowerExtension(path) == ".geo") return LoadGeoScript(path);
  return LoadCad(path);
}

void Fill(const std::string& where, double size, const GenerateOptions& options) {
  if (std::isfinite(size)) {
    gmsh::option::setNumber("Mesh.MeshSizeMin", size);
    gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  }
  if (options.per_circle > 0) {
    constexpr double kSmallest = 0.05;  // share of the size: tiny fillets shall not rule the mesh
    gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", options.per_circle);
    if (std::isfinite(size)) gmsh::option::setNumber("Mesh.MeshSizeMin", kSmallest * size);
  }
  gmsh::option::setNumber("Mesh.Optimize", options.optimise > 0);
  const std::string problem = GmshComplaint([&] {
    gmsh::model::mesh::generate(3);
    if (options.optimise > 1) gmsh::model::mesh::optimize("", true);
  });
  if (problem.empty()) return;
  const bool cross = problem.find("PLC") != std::string::npos ||
                     problem.find("ntersect") != std::string::npos ||
                     problem.find("verlapping") != std::string::npos;
  throw InputError(
      where,
      fmt::format("Gmsh cannot fill it with tetrahedra{} ({})",
                  cross ? ": the triangles of its surface cross each other" : "", problem),
      cross ? "Take a smaller --size; if that does not help, unite overlapping bodies "
              "in your CAD program."
            : "Take another --size, and look at the surface in Gmsh or MeshLab.");
}

// A slip in --size shall not eat up the memory. Volume and size in the same unit.
void RefuseIfTooFine(double volume, double size) {
  constexpr double kMostElements = 2e7;             // far beyond what a run can use
  const double element = size * size * size / 8.5;  // volume of a regular tetrahedron
  if (!(volume / element > kMostElements)) return;
  throw InputError("--size",
                   fmt::format("would take about {:.0e} tetrahedra, must be at most {:.0e}",
                               volume / element, kMostElements),
                   "Take a larger size; half of the thinnest wall is a good one.");
}

GeneratedMesh Generate(const std::filesystem::path& path, double metres_per_unit,
                       const GenerateOptions& options) {
  const std::string where = path.string();
  const double size = options.size / metres_per_unit;
  const GmshSession session;
  gmsh::option::setNumber("General.NumThreads", 1);  // for the same mesh every time
  const double volume = Load(path, size, options);
  RefuseIfTooFine(volume, size);
  Fill(where, size, options);

  GeneratedMesh generated;
  generated.mesh = MeshOfGmshModel(where);
  DropUngroupedVolumes(generated);
  DropUnusedNodes(generated.mesh);
  if (generated.mesh.num_elements() == 0) {
    throw InputError(where, "Gmsh fills it with no tetrahedra", "Take a smaller --size.");
  }
  generated.mesh.nodes *= metres_per_unit;
  generated.solid_volume = volume * metres_per_unit * metres_per_unit * metres_per_unit;
  return generated;
}

}  // namespace

std::string LowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c;
  return extension;
}

void GenerateOptions::Check() const {
  if (!std::isnan(size) && !(size > 0 && std::isfinite(size))) {
    throw InputError("--size", fmt::format("got {} mm, must be > 0", 1e3 * size),
                     "Write for example: --size \"5 mm\"");
  }
  if (!(feature_angle > 0 && feature_angle < 3.1415)) {
    throw InputError(
        "--feature-angle",
        fmt::format("got {:.4g} deg, must be within 0 and 180 deg", feature_angle * 180 / EIGEN_PI),
        "Write for example: --feature-angle \"40 deg\"");
  }
  if (optimise < 0 || optimise > 2) {
    throw InputError("--optimise", fmt::format("got {}, must be 0, 1 or 2", optimise));
  }
  if (per_circle < 0 || per_circle > 1000) {
    throw InputError("--per-circle", fmt::format("got {}, must be within 0 and 1000", per_circle));
  }
}

bool IsGeometryFile(const std::filesystem::path& path) {
  const std::string extension = LowerExtension(path);
  return extension == ".stl" || extension == ".step" || extension == ".stp" ||
         extension == ".brep" || extension == ".geo";
}

bool CarriesItsUnit(const std::filesystem::path& path) {
  return LowerExtension(path) == ".step" || LowerExtension(path) == ".stp";
}

GeneratedMesh GenerateMesh(const std::filesystem::path& path, double metres_per_unit,
                           const GenerateOptions& options) {
  assert(IsGeometryFile(path) && metres_per_unit > 0);
  options.Check();
  const std::string where = path.string();
  if (!std::filesystem::exists(path)) throw InputError(where, "there is no such file");
  if (!std::filesystem::is_regular_file(path)) throw InputError(where, "is not a file");
  if (std::filesystem::file_size(path) == 0) {
    throw InputError(where, "the file is empty", "Export it again.");
  }
  const bool says_size = LowerExtension(path) == ".geo" || LowerExtension(path) == ".stl";
  if (std::isnan(options.size) && !says_size) {
    throw InputError(where, "a CAD file does not say how large the tetrahedra shall be",
                     "Add for example: --size \"5 mm\"; half of the thinnest wall is a good size.");
  }
  const double scale = CarriesItsUnit(path) ? 1e-3 : metres_per_unit;  // STEP is read in mm
  return RunIsolated(where, [&] { return Generate(path, scale, options); });
}

}  // namespace softforce::mesh
