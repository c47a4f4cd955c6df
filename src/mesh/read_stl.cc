#include "mesh/read_stl.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <utility>

#include "mesh/point_grid.h"
#include "mesh/stl_crossings.h"
#include "mesh/stl_file.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;
using Triangle = std::array<int, 3>;

// Exporters round the same corner differently: corners closer than this share of the body's size
// are one. Numbers in binary files have 1.2e-7.
constexpr double kSameCorner = 1e-6;

std::string Place(const Eigen::Vector3d& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}), in the file's unit", p.x(), p.y(), p.z());
}

void JoinCorners(const Eigen::Matrix3Xd& corners, StlSurface& surface) {
  const double size = (corners.rowwise().maxCoeff() - corners.rowwise().minCoeff()).norm();
  PointGrid grid(kSameCorner * size);
  const auto node_at = [&](const Eigen::Vector3d& p) {
    const int known = grid.Find(p);
    return known >= 0 ? known : grid.Add(p);
  };
  for (Eigen::Index i = 0; size > 0 && i < corners.cols(); i += 3) {
    const Triangle t{node_at(corners.col(i)), node_at(corners.col(i + 1)),
                     node_at(corners.col(i + 2))};
    // Slivers that collapse leave no gap: their neighbours then share the edge.
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) surface.triangles.push_back(t);
  }
  surface.nodes.resize(3, static_cast<Eigen::Index>(grid.points().size()));
  for (Eigen::Index n = 0; n < surface.nodes.cols(); ++n) surface.nodes.col(n) = grid.points()[n];
}

using EdgeMap = std::map<std::pair<int, int>, std::vector<int>>;  // triangles at each edge

EdgeMap FindEdges(const StlSurface& surface) {
  EdgeMap edges;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& n = surface.triangles[t];
    for (int i = 0; i < 3; ++i) {
      edges[std::minmax({n[i], n[(i + 1) % 3]})].push_back(static_cast<int>(t));
    }
  }
  return edges;
}

void RefuseIfNotClosed(const std::string& where, const StlSurface& surface, const EdgeMap& edges) {
  int open = 0, crowded = 0;
  Eigen::Vector3d first_open, first_crowded;
  for (const auto& [ends, triangles] : edges) {
    const Eigen::Vector3d middle =
        (surface.nodes.col(ends.first) + surface.nodes.col(ends.second)) / 2;
    if (triangles.size() == 1 && open++ == 0) first_open = middle;
    if (triangles.size() > 2 && crowded++ == 0) first_crowded = middle;
  }
  if (open > 0) {
    throw InputError(where,
                     fmt::format("the surface is not closed: {} edge{} only one triangle, the "
                                 "first at {}",
                                 open, open == 1 ? " has" : "s have", Place(first_open)),
                     "Close the holes in your CAD program (or with MeshLab, Blender's 3D-Print "
                     "toolbox), and export it again.");
  }
  if (crowded > 0) {
    throw InputError(
        where,
        fmt::format("surfaces touch: {} edge{} more than two triangles, the first at {}", crowded,
                    crowded == 1 ? " has" : "s have", Place(first_crowded)),
        "Unite bodies that touch in your CAD program, so that one surface bounds them, and export "
        "it again.");
  }
}

double SignedVolume(const StlSurface& surface, int shell) {
  double six_volumes = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.shell[t] != shell) continue;
    const Triangle& n = surface.triangles[t];
    six_volumes += surface.nodes.col(n[0]).dot(
        Eigen::Vector3d(surface.nodes.col(n[1])).cross(Eigen::Vector3d(surface.nodes.col(n[2]))));
  }
  return six_volumes / 6;
}

// Whether a triangle runs along the edge from a to b in this direction.
bool Runs(const Triangle& n, int a, int b) {
  for (int i = 0; i < 3; ++i) {
    if (n[i] == a && n[(i + 1) % 3] == b) return true;
  }
  return false;
}

// Numbers the connected surfaces, and turns each one's triangles the same way round.
void FindShells(const std::string& where, const EdgeMap& edges, StlSurface& surface) {
  const int count = static_cast<int>(surface.triangles.size());
  surface.shell.assign(count, -1);
  int shell = 0;
  for (int first = 0; first < count; ++first) {
    if (surface.shell[first] >= 0) continue;
    std::queue<int> waiting({first});
    surface.shell[first] = shell;
    for (; !waiting.empty(); waiting.pop()) {
      const Triangle n = surface.triangles[waiting.front()];
      for (int i = 0; i < 3; ++i) {
        const int a = n[i], b = n[(i + 1) % 3];
        for (const int other : edges.at(std::minmax({a, b}))) {
          if (other == waiting.front()) continue;
          Triangle& m = surface.triangles[other];
          if (surface.shell[other] < 0) {
            if (Runs(m, a, b)) std::swap(m[1], m[2]);
            surface.shell[other] = shell;
            waiting.push(other);
          } else if (Runs(m, a, b)) {
            throw InputError(where, "its surface has no inside and outside, like a Moebius strip",
                             kStlAdvice);
          }
        }
      }
    }
    surface.shell_volumes.push_back(std::abs(SignedVolume(surface, shell)));
    ++shell;
  }
}

// How often a ray from p in a direction without regard to the axes crosses a shell.
bool IsInside(const StlSurface& surface, int shell, const Eigen::Vector3d& p) {
  const Eigen::Vector3d direction(0.5377, 0.3183, 0.7802);
  bool inside = false;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.shell[t] != shell) continue;
    const Triangle& n = surface.triangles[t];
    Eigen::Matrix3d edges;
    edges << surface.nodes.col(n[1]) - surface.nodes.col(n[0]),
        surface.nodes.col(n[2]) - surface.nodes.col(n[0]), -direction;
    const Eigen::Vector3d solution =
        edges.fullPivLu().solve(Eigen::Vector3d(p - surface.nodes.col(n[0])));
    const bool hit = solution.allFinite() && solution(0) >= 0 && solution(1) >= 0 &&
                     solution(0) + solution(1) <= 1 && solution(2) > 0;
    inside ^= hit;
  }
  return inside;
}

void FindNesting(StlSurface& surface) {
  std::vector<Eigen::Vector3d> point(surface.num_shells());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    point[surface.shell[t]] = surface.nodes.col(surface.triangles[t][0]);
  }
  std::vector<std::vector<int>> around(surface.num_shells());  // the shells around each one
  for (int inner = 0; inner < surface.num_shells(); ++inner) {
    for (int outer = 0; outer < surface.num_shells(); ++outer) {
      if (outer != inner && IsInside(surface, outer, point[inner])) around[inner].push_back(outer);
    }
  }
  surface.parent.assign(surface.num_shells(), -1);
  for (int inner = 0; inner < surface.num_shells(); ++inner) {
    surface.depth.push_back(static_cast<int>(around[inner].size()));
    for (const int outer : around[inner]) {  // the innermost has as many around it, less itself
      if (around[outer].size() + 1 == around[inner].size()) surface.parent[inner] = outer;
    }
  }
}

}  // namespace

StlSurface ReadStl(const std::filesystem::path& path) {
  const std::string where = path.string();
  StlSurface surface;
  JoinCorners(ReadStlCorners(path), surface);
  if (surface.triangles.empty()) {
    throw InputError(where, "all of its triangles are without area", kStlAdvice);
  }
  const EdgeMap edges = FindEdges(surface);
  RefuseIfNotClosed(where, surface, edges);
  FindShells(where, edges, surface);
  if (const auto p = FindCrossing(surface)) {
    throw InputError(where, fmt::format("its surface crosses itself at {}", Place(*p)),
                     "Unite overlapping bodies in your CAD program, and export it again.");
  }
  FindNesting(surface);
  return surface;
}

}  // namespace softforce::mesh
