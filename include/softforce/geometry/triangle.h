#pragma once

#include <Eigen/Core>

namespace softforce::geometry {

struct ClosestOnTriangle {
  Eigen::Vector3d barycentric;  // weights of a, b, c; each in [0, 1], sum 1
  Eigen::Vector3d point;
  double distance;
};

// The point of triangle abc (a degenerate one is an edge or a point) that is closest to p.
ClosestOnTriangle ClosestPointOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                         const Eigen::Vector3d& c, const Eigen::Vector3d& p);

}  // namespace softforce::geometry
