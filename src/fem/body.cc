#include "softforce/fem/body.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <map>
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

// Refuses walls with an open rim that could move: pressure would escape, and its work depend on the
// way that the rim goes.
void CheckClosed(const Chamber& chamber, const mesh::TetMesh& mesh, const std::set<int>& fixed,
                 const std::string& where) {
  std::map<std::pair<int, int>, int> walls_at;  // edge, both ways round → walls
  std::set<std::pair<int, int>> held;
  for (Eigen::Index t = 0; t < chamber.walls.cols(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int from = chamber.walls(i, t), to = chamber.walls((i + 1) % 3, t);
      const std::pair<int, int> edge = std::minmax(from, to);
      ++walls_at[edge];
      const bool middle_held =
          chamber.walls.rows() == 3 || fixed.count(chamber.walls(3 + i, t)) > 0;
      if (fixed.count(from) > 0 && fixed.count(to) > 0 && middle_held) held.insert(edge);
    }
  }
  int open = 0;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  for (const auto& [edge, walls] : walls_at) {
    if (walls % 2 == 0 || held.count(edge) > 0) continue;
    if (open++ == 0) {
      at_mm = 500 * (mesh.nodes.col(edge.first) + mesh.nodes.col(edge.second));
    }
  }
  if (open == 0) return;
  throw base::InputError(
      where,
      fmt::format("its walls are not closed: {} edges border on one triangle only, the first "
                  "at ({:.1f} {:.1f} {:.1f}) mm; every edge must join two triangles, or lie where "
                  "the body is fixed",
                  open, at_mm.x(), at_mm.y(), at_mm.z()),
      "Name the whole inside of the hollow as one surface group.");
}

// Whether holding these components of displacement at zero leaves no rigid motion: the six motions
// v + ω × (X − centre), seen at the held components, are then independent.
bool KeepsFromMoving(const std::vector<FixedComponent>& held, const Eigen::Matrix3Xd& X) {
  if (held.empty()) return false;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const FixedComponent& component : held) centre += X.col(component.node);
  centre /= static_cast<double>(held.size());
  double size = 0;
  for (const FixedComponent& component : held) {
    size = std::max(size, (X.col(component.node) - centre).norm());
  }
  if (size == 0) return false;

  Eigen::Matrix<double, 6, 6> seen = Eigen::Matrix<double, 6, 6>::Zero();
  for (const FixedComponent& component : held) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(component.axis);
    Eigen::Matrix<double, 6, 1> motion;
    motion << axis, ((X.col(component.node) - centre) / size).cross(axis);
    seen += motion * motion.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> modes(seen,
                                                                         Eigen::EigenvaluesOnly);
  return modes.eigenvalues()(0) > 1e-12 * modes.eigenvalues()(5);
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

  for (const Chamber& chamber : chambers) {
    CheckClosed(chamber, mesh, fixed, fmt::format("{}: chamber \"{}\"", where, chamber.name));
  }

  std::vector<FixedComponent> held = fixed_components;
  for (const int node : fixed_nodes) {
    for (int axis = 0; axis < 3; ++axis) held.push_back({node, axis});
  }
  const std::vector<int> part = Parts(mesh);
  std::map<int, std::vector<FixedComponent>> held_of_part;
  for (const int name : part) held_of_part[name];
  for (const FixedComponent& component : held) {
    held_of_part[part[component.node]].push_back(component);
  }
  for (const auto& [node, held_here] : held_of_part) {
    if (KeepsFromMoving(held_here, mesh.nodes)) continue;
    const Eigen::Vector3d at_mm = 1000 * mesh.nodes.col(node);
    std::set<int> held_nodes;
    for (const FixedComponent& component : held_here) held_nodes.insert(component.node);
    const std::string which =
        held_of_part.size() == 1
            ? "the body"
            : fmt::format(
                  "the mesh falls into {} parts that share no node; the one around "
                  "({:.1f} {:.1f} {:.1f}) mm",
                  held_of_part.size(), at_mm.x(), at_mm.y(), at_mm.z());
    throw base::InputError(
        where + ": fixed",
        fmt::format("{} is held at {} nodes, which do not keep it from drifting or turning; at "
                    "least 3 nodes that are not in line are needed",
                    which, held_nodes.size()),
        held_of_part.size() == 1
            ? "Check the boxes and groups under 'fixed' against the mesh: its unit, and where it "
              "stands."
            : "Join the parts when meshing (in Gmsh: fragment the volumes, or merge duplicate "
              "nodes), or fix each of them.");
  }
}

}  // namespace softforce::fem
