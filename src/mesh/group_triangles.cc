#include <fmt/format.h>

#include <array>
#include <set>

#include "softforce/base/input_error.h"
#include "softforce/mesh/surface_groups.h"

namespace softforce::mesh {
namespace {

std::string GroupNames(const TetMesh& mesh) {
  std::vector<std::string> names;
  for (const auto& [name, triangles] : mesh.surface_groups) names.push_back(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<int> GroupTriangles(const std::string& group, const TetMesh& mesh,
                                const Surface& surface, const std::string& where) {
  const auto found = mesh.surface_groups.find(group);
  if (found == mesh.surface_groups.end()) {
    throw base::InputError(
        where,
        fmt::format("the mesh has no surface group \"{}\"; it has: {}", group, GroupNames(mesh)),
        "Name one with: softforce mesh --help");
  }
  std::set<std::array<int, 3>> wanted;
  for (const std::array<int, 3>& corners : found->second) wanted.insert(Sorted(corners));
  std::vector<int> triangles;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const std::array<int, 3> corners{surface.triangles(0, t), surface.triangles(1, t),
                                     surface.triangles(2, t)};
    if (wanted.count(Sorted(corners)) > 0) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace softforce::mesh
