#include "softforce/mesh/surface_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/connectivity.h"

namespace softforce::mesh {
namespace {

// Edges that one step may cross; a walk that is caught in a corner ends there.
constexpr int kMaxCrossings = 1000;

std::pair<int, int> EdgeOf(const Eigen::Matrix3Xi& triangles, int t, int i) {
  const int a = triangles(i, t), b = triangles((i + 1) % 3, t);
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

SurfaceWalk::SurfaceWalk(const Surface& surface, const Eigen::Matrix3Xd& X, std::vector<int> region)
    : triangles_(surface.triangles.topRows<3>()),
      X_(X),
      normals_(FlatNormals(surface, X)),
      region_(std::move(region)),
      beyond_(static_cast<size_t>(surface.num_triangles()), {-1, -1, -1}) {
  std::map<std::pair<int, int>, std::pair<int, int>> first;  // edge → triangle, number of its edge
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) first.emplace(EdgeOf(triangles_, t, i), std::make_pair(t, i));
  }
  for (const TrianglePair& pair : Neighbours(surface)) {
    if (region_[pair.first] != region_[pair.second]) continue;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (EdgeOf(triangles_, pair.first, i) != EdgeOf(triangles_, pair.second, j)) continue;
        beyond_[pair.first][i] = pair.second;
        beyond_[pair.second][j] = pair.first;
      }
    }
  }
}

Eigen::Vector3d SurfaceWalk::Corner(int triangle, int i) const {
  return X_.col(triangles_(i % 3, triangle));
}

Eigen::Vector3d SurfaceWalk::Position(const SurfacePoint& point) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) sum += point.barycentric(i) * Corner(point.triangle, i);
  return sum;
}

Eigen::Matrix<double, 3, 2> SurfaceWalk::Tangents(int triangle) const {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = (Corner(triangle, 1) - Corner(triangle, 0)).normalized();
  tangents.col(1) = Eigen::Vector3d(normals_.col(triangle)).cross(tangents.col(0));
  return tangents;
}

SurfacePoint SurfaceWalk::Step(const SurfacePoint& from, const Eigen::Vector3d& step) const {
  SurfacePoint at = from;
  const Eigen::Vector3d start_normal = normals_.col(at.triangle);
  Eigen::Vector3d left = step - start_normal.dot(step) * start_normal;
  for (int crossing = 0; crossing < kMaxCrossings && left.squaredNorm() > 0; ++crossing) {
    const int t = at.triangle;
    const Eigen::Vector3d normal = normals_.col(t);
    const double twice_area =
        normal.dot((Corner(t, 1) - Corner(t, 0)).cross(Corner(t, 2) - Corner(t, 0)));
    Eigen::Vector3d change;  // of the barycentric coordinates over the whole of what is left
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d opposite = Corner(t, i + 2) - Corner(t, i + 1);
      change(i) = normal.cross(opposite).dot(left) / twice_area;
    }
    double share = 1;  // of it that stays in this triangle
    int leaving = -1;  // the corner opposite of the edge that it leaves by
    for (int i = 0; i < 3; ++i) {
      if (change(i) >= 0 || at.barycentric(i) + change(i) >= 0) continue;
      const double reach = std::max(0.0, at.barycentric(i) / -change(i));
      if (leaving >= 0 && reach >= share) continue;
      share = reach;
      leaving = i;
    }
    at.barycentric += share * change;
    if (leaving < 0) break;
    at.barycentric(leaving) = 0;
    left *= 1 - share;
    const int edge = (leaving + 1) % 3;
    const Eigen::Vector3d along = (Corner(t, edge + 1) - Corner(t, edge)).normalized();
    const int next = beyond_[t][edge];
    if (next < 0) {
      const Eigen::Vector3d sliding = along.dot(left) * along;
      // In a corner from which no edge leads on the way.
      if (share == 0 && (left - sliding).norm() <= 1e-12 * left.norm()) break;
      left = sliding;
      continue;
    }
    // Into the next triangle's plane, about the edge.
    const Eigen::Vector3d inward_here = normal.cross(along);
    const Eigen::Vector3d next_normal = normals_.col(next);
    const Eigen::Vector3d outward_there = next_normal.cross(along);
    left = along.dot(left) * along + inward_here.dot(left) * outward_there;
    SurfacePoint there{next, Eigen::Vector3d::Zero()};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (triangles_(i, next) == triangles_(j, t)) there.barycentric(i) = at.barycentric(j);
      }
    }
    at = there;
  }
  at.barycentric = at.barycentric.cwiseMax(0);
  at.barycentric /= at.barycentric.sum();
  return at;
}

std::vector<int> SmoothFaces(const Surface& surface, const Eigen::Matrix3Xd& X, double crease) {
  const Eigen::Matrix3Xd normals = FlatNormals(surface, X);
  DisjointSets sets(surface.num_triangles());
  for (const TrianglePair& pair : Neighbours(surface)) {
    if (normals.col(pair.first).dot(normals.col(pair.second)) < std::cos(crease)) continue;
    sets.Join(pair.first, pair.second);
  }
  return sets.Numbers();
}

}  // namespace softforce::mesh
