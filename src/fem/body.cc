#include "softforce/fem/body.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <numeric>
#include <set>

#include "softforce/base/input_error.h"

namespace softforce::fem {
namespace {

constexpr double kShortestCable = 1e-6;  // m

// Which part each node belongs to: parts are sets of nodes connected through cells.
std::vector<int> Parts(const mesh::TetMesh& mesh) {
  std::vector<int> parent(mesh.num_nodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (int i = 1; i < mesh.elements.rows(); ++i) {
      parent[root(mesh.elements(i, e))] = root(mesh.elements(0, e));
    }
  }
  for (int node = 0; node < mesh.num_nodes(); ++node) parent[node] = root(node);
  return parent;
}

// Whether points span at least a plane, so that a body held there cannot move.
bool SpanAPlane(const Eigen::Matrix3Xd& points) {
  if (points.cols() < 3) return false;
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose(),
                                                            Eigen::EigenvaluesOnly);
  return axes.eigenvalues()(1) > 1e-12 * axes.eigenvalues()(2);  // squared extents, ascending
}

}  // namespace

void Body::Check(const std::string& where) const {
  for (const Material& material : materials) material.Check(where + ": material");

  const std::set<int> fixed(fixed_nodes.begin(), fixed_nodes.end());
  if (static_cast<int>(fixed.size()) == mesh.num_nodes()) {
    throw base::InputError(where + ": fixed", "holds every node of the mesh: nothing can move");
  }
  for (const Cable& cable : cables) {
    const auto is_fixed = [&](int node) { return fixed.count(node) > 0; };
    for (const mesh::NodalWeights& point : cable.points) {
      if (!std::all_of(point.nodes.begin(), point.nodes.end(), is_fixed)) continue;
      throw base::InputError(fmt::format("{}: cable \"{}\"", where, cable.name),
                             "has a point where the body is fixed, so that it cannot pull there");
    }
    if ((cable.points.back().Apply(mesh.nodes) - cable.guide).norm() < kShortestCable) {
      throw base::InputError(fmt::format("{}: cable \"{}\"", where, cable.name),
                             "ends where its guide is, so that it has no direction");
    }
  }

  const std::vector<int> part = Parts(mesh);
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (part[node] != node) continue;  // a part is named by one of its nodes
    std::vector<int> held;
    for (const int held_node : fixed_nodes) {
      if (part[held_node] == node) held.push_back(held_node);
    }
    if (SpanAPlane(mesh.nodes(Eigen::all, held))) continue;
    const Eigen::Vector3d at_mm = 1000 * mesh.nodes.col(node);
    throw base::InputError(
        where + ": fixed",
        fmt::format(
            "the part of the body around ({:.1f} {:.1f} {:.1f}) mm is held at {} nodes, which do "
            "not "
            "keep it from drifting or turning; at least 3 nodes that are not in line are needed",
            at_mm.x(), at_mm.y(), at_mm.z(), held.size()),
        "Check the boxes and groups under 'fixed' against the mesh: its unit, and where it "
        "stands.");
  }
}

}  // namespace softforce::fem
