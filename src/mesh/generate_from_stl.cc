#include <fmt/format.h>
#include <gmsh.h>

#include <map>
#include <string>
#include <vector>

#include "mesh/generate.h"
#include "mesh/gmsh_session.h"
#include "mesh/read_stl.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;
using Surfaces = std::vector<std::vector<int>>;  // of each shell: its surfaces in Gmsh's model

// One surface per shell.
Surfaces AddShells(const StlSurface& stl) {
  Surfaces surfaces(stl.num_shells());
  std::vector<char> added(stl.nodes.cols(), false);
  for (int shell = 0; shell < stl.num_shells(); ++shell) {
    std::vector<std::size_t> tags, nodes;
    std::vector<double> coordinates;
    for (std::size_t t = 0; t < stl.triangles.size(); ++t) {
      if (stl.shell[t] != shell) continue;
      for (const int node : stl.triangles[t]) {
        nodes.push_back(std::size_t(node) + 1);
        if (added[node]) continue;
        added[node] = true;
        tags.push_back(std::size_t(node) + 1);
        for (int i = 0; i < 3; ++i) coordinates.push_back(stl.nodes(i, node));
      }
    }
    const int surface = gmsh::model::addDiscreteEntity(2);
    gmsh::model::mesh::addNodes(2, surface, tags, coordinates);
    gmsh::model::mesh::addElementsByType(surface, 2, {}, nodes);
    surfaces[shell] = {surface};
  }
  return surfaces;
}

// Divides the shells along their sharp edges into surfaces that can be cut into triangles anew.
Surfaces Reparametrise(const StlSurface& stl, double feature_angle) {
  constexpr double kWholeCurves = 3.14159265358979323846;
  gmsh::model::mesh::classifySurfaces(feature_angle, true, true, kWholeCurves);
  gmsh::model::mesh::createGeometry();

  std::map<std::array<double, 3>, int> shell_at;  // dividing does not move the nodes
  for (std::size_t t = 0; t < stl.triangles.size(); ++t) {
    const Eigen::Vector3d p = stl.nodes.col(stl.triangles[t][0]);
    const Eigen::Vector3d q = stl.nodes.col(stl.triangles[t][1]);
    const Eigen::Vector3d r = stl.nodes.col(stl.triangles[t][2]);
    for (const auto& n : {p, q, r}) shell_at[{n.x(), n.y(), n.z()}] = stl.shell[t];
  }
  Surfaces surfaces(stl.num_shells());
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, 2);
  for (const auto& entity : entities) {
    std::vector<std::size_t> tags;
    std::vector<double> xyz, parameters;
    gmsh::model::mesh::getNodes(tags, xyz, parameters, 2, entity.second, true);
    if (xyz.size() < 3) continue;
    const auto found = shell_at.find({xyz[0], xyz[1], xyz[2]});
    if (found != shell_at.end()) surfaces[found->second].push_back(entity.second);
  }
  return surfaces;
}

// A volume for each solid: within an even number of shells; the shells directly in it bound
// cavities.
void AddVolumes(const StlSurface& stl, const Surfaces& surfaces) {
  std::vector<int> loop;
  for (const auto& of_shell : surfaces) {
    loop.push_back(gmsh::model::geo::addSurfaceLoop(of_shell));
  }
  for (int outer = 0; outer < stl.num_shells(); ++outer) {
    if (stl.depth[outer] % 2 != 0) continue;
    std::vector<int> loops{loop[outer]};
    for (int inner = 0; inner < stl.num_shells(); ++inner) {
      if (stl.parent[inner] == outer) loops.push_back(loop[inner]);
    }
    gmsh::model::geo::addVolume(loops);
  }
  gmsh::model::geo::synchronize();
}

}  // namespace

double LoadStl(const std::filesystem::path& path, double size, double feature_angle) {
  const StlSurface stl = ReadStl(path);
  const std::string problem = GmshComplaint([&] {
    Surfaces surfaces = AddShells(stl);
    if (std::isfinite(size)) surfaces = Reparametrise(stl, feature_angle);
    AddVolumes(stl, surfaces);
  });
  if (!problem.empty()) {
    throw InputError(
        path.string(), fmt::format("its surface cannot be divided into smooth parts ({})", problem),
        "Leave --size out to keep the file's own triangles, or remesh the surface first, for "
        "example in MeshLab or Blender.");
  }
  double volume = 0;
  for (int shell = 0; shell < stl.num_shells(); ++shell) {
    volume += (stl.depth[shell] % 2 == 0 ? 1 : -1) * stl.shell_volumes[shell];
  }
  return volume;
}

}  // namespace softforce::mesh
