#include "mesh/closest_triangle.h"

#include <cassert>
#include <limits>
#include <numeric>

#include "softforce/geometry/triangle.h"

namespace softforce::mesh {

double SquaredDistanceToBox(const Surface& surface, const Eigen::Matrix3Xd& x, int triangle,
                            const Eigen::Vector3d& p) {
  const auto a = x.col(surface.triangles(0, triangle)).array();
  const auto b = x.col(surface.triangles(1, triangle)).array();
  const auto c = x.col(surface.triangles(2, triangle)).array();
  const Eigen::Array3d below = a.min(b).min(c) - p.array();
  const Eigen::Array3d above = p.array() - a.max(b).max(c);
  return below.max(above).max(0).matrix().squaredNorm();
}

SurfaceProjection ClosestAmong(const std::vector<int>& triangles, const Surface& surface,
                               const Eigen::Matrix3Xd& x, const Eigen::Vector3d& p) {
  assert(!triangles.empty());
  SurfacePoint best;
  double least = std::numeric_limits<double>::infinity();
  for (const int t : triangles) {
    if (SquaredDistanceToBox(surface, x, t, p) >= least * least) continue;
    const auto closest = geometry::ClosestPointOnTriangle(x.col(surface.triangles(0, t)),
                                                          x.col(surface.triangles(1, t)),
                                                          x.col(surface.triangles(2, t)), p);
    if (closest.distance >= least) continue;
    least = closest.distance;
    best = {t, closest.barycentric};
  }
  const Eigen::Vector3d position = Position(surface, x, best);
  return {best, position, (p - position).norm()};
}

SurfaceProjection ClosestSurfacePoint(const Surface& surface, const Eigen::Matrix3Xd& x,
                                      const Eigen::Vector3d& p) {
  std::vector<int> all(surface.num_triangles());
  std::iota(all.begin(), all.end(), 0);
  return ClosestAmong(all, surface, x, p);
}

}  // namespace softforce::mesh
