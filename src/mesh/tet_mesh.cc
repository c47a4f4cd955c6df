#include "softforce/mesh/tet_mesh.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <unordered_map>

namespace softforce::mesh {

std::array<int, 3> Sorted(std::array<int, 3> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

TetMesh RaiseOrder(const TetMesh& mesh) {
  if (mesh.order() == 2) return mesh;
  TetMesh raised = mesh;
  raised.elements.resize(10, mesh.num_elements());
  raised.elements.topRows(4) = mesh.elements;

  // New nodes are numbered as their edges first occur.
  std::unordered_map<std::uint64_t, int> middle_of_edge;
  middle_of_edge.reserve(2 * mesh.num_elements());
  std::vector<Eigen::Vector3d> middles;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (int i = 0; i < 6; ++i) {
      const int a = mesh.elements(kEdges[i][0], e);
      const int b = mesh.elements(kEdges[i][1], e);
      const auto key = std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
      const int next = mesh.num_nodes() + static_cast<int>(middles.size());
      const auto [entry, is_new] = middle_of_edge.try_emplace(key, next);
      if (is_new) middles.push_back(0.5 * (mesh.nodes.col(a) + mesh.nodes.col(b)));
      raised.elements(4 + i, e) = entry->second;
    }
  }
  raised.nodes.conservativeResize(3, mesh.num_nodes() + static_cast<int>(middles.size()));
  for (std::size_t i = 0; i < middles.size(); ++i) {
    raised.nodes.col(mesh.num_nodes() + static_cast<int>(i)) = middles[i];
  }
  return raised;
}

TetMesh LowerOrder(const TetMesh& mesh) {
  if (mesh.order() == 1) return mesh;

  // Middle nodes go; corners stay, and so do nodes without an element, which CheckMesh refuses.
  std::vector<char> keep(mesh.num_nodes(), true);
  for (const int node : mesh.elements.bottomRows(6).reshaped()) keep[node] = false;
  for (const int node : mesh.elements.topRows(4).reshaped()) keep[node] = true;

  TetMesh lowered;
  std::vector<int> number(mesh.num_nodes(), -1);
  int num_kept = 0;
  lowered.nodes.resize(3, mesh.num_nodes());
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (!keep[node]) continue;
    lowered.nodes.col(num_kept) = mesh.nodes.col(node);
    number[node] = num_kept++;
  }
  lowered.nodes.conservativeResize(3, num_kept);

  lowered.elements = mesh.elements.topRows(4).unaryExpr([&](int node) { return number[node]; });
  lowered.region = mesh.region;
  lowered.region_names = mesh.region_names;
  lowered.surface_groups = mesh.surface_groups;
  for (auto& [name, triangles] : lowered.surface_groups) {
    for (auto& triangle : triangles) {
      for (int& node : triangle) node = number[node];
    }
  }
  return lowered;
}

TetMesh WithOrder(const TetMesh& mesh, int order) {
  assert(order == 1 || order == 2);
  return order == 2 ? RaiseOrder(mesh) : LowerOrder(mesh);
}

}  // namespace softforce::mesh
