#include "softforce/geometry/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

namespace softforce::geometry {
namespace {

// The share of the way from `from` to `to` at which p is closest.
double ClosestShare(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    const Eigen::Vector3d& p) {
  const Eigen::Vector3d edge = to - from;
  const double length2 = edge.squaredNorm();
  return length2 > 0 ? std::clamp(edge.dot(p - from) / length2, 0.0, 1.0) : 0.0;
}

}  // namespace

ClosestOnTriangle ClosestPointOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                         const Eigen::Vector3d& c, const Eigen::Vector3d& p) {
  const std::array<Eigen::Vector3d, 3> corner{a, b, c};
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double n2 = n.squaredNorm();
  if (n2 > 0) {  // barycentric coordinates of the foot of the perpendicular
    Eigen::Vector3d w;
    w(1) = n.dot((p - a).cross(c - a)) / n2;
    w(2) = n.dot((b - a).cross(p - a)) / n2;
    w(0) = 1 - w(1) - w(2);
    if (w.minCoeff() >= 0) {
      const Eigen::Vector3d point = w(0) * a + w(1) * b + w(2) * c;
      return {w, point, (p - point).norm()};
    }
  }
  // Outside the prism over the triangle: the closest point lies on one of the edges.
  ClosestOnTriangle best{Eigen::Vector3d::UnitX(), a, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double share = ClosestShare(corner[i], corner[j], p);
    const Eigen::Vector3d point = (1 - share) * corner[i] + share * corner[j];
    const double distance = (p - point).norm();
    if (distance < best.distance) {
      best.barycentric.setZero();
      best.barycentric(i) = 1 - share;
      best.barycentric(j) = share;
      best.point = point;
      best.distance = distance;
    }
  }
  return best;
}

}  // namespace softforce::geometry
