#include "mesh/stl_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <vector>

namespace softforce::mesh {
namespace {

// Shares of an edge's length: an edge that ends on a triangle only touches it.
constexpr double kTouch = 1e-6;
// Shares of a triangle: an edge may run through the border of two triangles.
constexpr double kBorder = 1e-9;

struct Corners {
  Eigen::Vector3d a, b, c, low, high;
};

Corners CornersOf(const StlSurface& surface, int t) {
  const auto& n = surface.triangles[t];
  Corners corners{
      surface.nodes.col(n[0]), surface.nodes.col(n[1]), surface.nodes.col(n[2]), {}, {}};
  corners.low = corners.a.cwiseMin(corners.b).cwiseMin(corners.c);
  corners.high = corners.a.cwiseMax(corners.b).cwiseMax(corners.c);
  return corners;
}

std::optional<Eigen::Vector3d> Cross(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                     const Corners& triangle) {
  const Eigen::Vector3d u = triangle.b - triangle.a, v = triangle.c - triangle.a;
  const Eigen::Vector3d normal = u.cross(v);
  const double before = normal.dot(from - triangle.a), after = normal.dot(to - triangle.a);
  if (before * after >= 0) return std::nullopt;
  const double share = before / (before - after);
  if (share < kTouch || share > 1 - kTouch) return std::nullopt;
  const Eigen::Vector3d p = from + share * (to - from);
  const double square = normal.squaredNorm();
  const double of_b = normal.dot((p - triangle.a).cross(v)) / square;
  const double of_c = normal.dot(u.cross(p - triangle.a)) / square;
  if (of_b < -kBorder || of_c < -kBorder || of_b + of_c > 1 + kBorder) return std::nullopt;
  return p;
}

bool ShareANode(const StlSurface& surface, int s, int t) {
  for (const int a : surface.triangles[s]) {
    for (const int b : surface.triangles[t]) {
      if (a == b) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<Eigen::Vector3d> FindCrossing(const StlSurface& surface) {
  const int count = static_cast<int>(surface.triangles.size());
  std::vector<Corners> corners;
  for (int t = 0; t < count; ++t) corners.push_back(CornersOf(surface, t));
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int s, int t) { return corners[s].low.x() < corners[t].low.x(); });

  for (int i = 0; i < count; ++i) {
    const Corners& s = corners[order[i]];
    for (int j = i + 1; j < count && corners[order[j]].low.x() <= s.high.x(); ++j) {
      const Corners& t = corners[order[j]];
      const bool apart = s.low.y() > t.high.y() || t.low.y() > s.high.y() ||
                         s.low.z() > t.high.z() || t.low.z() > s.high.z();
      if (apart || ShareANode(surface, order[i], order[j])) continue;
      for (const auto& [edges_of, other] : {std::pair(&s, &t), std::pair(&t, &s)}) {
        const Eigen::Vector3d* ends[4] = {&edges_of->a, &edges_of->b, &edges_of->c, &edges_of->a};
        for (int k = 0; k < 3; ++k) {
          if (const auto place = Cross(*ends[k], *ends[k + 1], *other)) return place;
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace softforce::mesh
