#include "softforce/scene/fixed_nodes.h"

#include <fmt/format.h>

#include <set>

#include "softforce/base/input_error.h"
#include "softforce/mesh/surface_groups.h"

namespace softforce::scene {

std::vector<int> FixedNodes(const Scene& scene, const mesh::TetMesh& mesh,
                            const mesh::Surface& surface) {
  constexpr double kRounding = 1e-9;  // m; so that a box flush with a face includes it
  std::set<int> fixed;
  for (size_t i = 0; i < scene.fixed.size(); ++i) {
    const FixedRegion& region = scene.fixed[i];
    const std::string where = fmt::format("{}: body: fixed: [{}]", scene.file.string(), i);
    std::set<int> nodes;
    if (!region.group.empty()) {
      for (const int t : mesh::GroupTriangles(region.group, mesh, surface, where)) {
        nodes.insert(surface.triangles.col(t).begin(), surface.triangles.col(t).end());
      }
    } else {
      for (int node = 0; node < mesh.num_nodes(); ++node) {
        const Eigen::Vector3d X = mesh.nodes.col(node);
        if (((X - region.box_min).array() >= -kRounding).all() &&
            ((region.box_max - X).array() >= -kRounding).all()) {
          nodes.insert(node);
        }
      }
    }
    if (nodes.empty()) {
      const Eigen::Vector3d low = 1000 * mesh.nodes.rowwise().minCoeff();
      const Eigen::Vector3d high = 1000 * mesh.nodes.rowwise().maxCoeff();
      throw base::InputError(where,
                             fmt::format("holds no node of the mesh, which spans {:.4g} to {:.4g}, "
                                         "{:.4g} to {:.4g}, {:.4g} to "
                                         "{:.4g} mm",
                                         low.x(), high.x(), low.y(), high.y(), low.z(), high.z()),
                             "Check the box against the mesh, and the mesh's unit.");
    }
    fixed.insert(nodes.begin(), nodes.end());
  }
  return {fixed.begin(), fixed.end()};
}

}  // namespace softforce::scene
