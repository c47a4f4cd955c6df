#include "pipeline/self_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace softforce::pipeline {

SelfCover::SelfCover(const mesh::Surface& surface, const Eigen::Matrix3Xd& x)
    : surface_(surface),
      corners_(3, 3 * surface.num_triangles()),
      middle_(3, surface.num_triangles()),
      radius_(surface.num_triangles()) {
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int k = 0; k < 3; ++k) corners_.col(3 * t + k) = x.col(surface.triangles(k, t));
    middle_.col(t) = corners_.middleCols<3>(3 * t).rowwise().mean();
    radius_(t) =
        (corners_.middleCols<3>(3 * t).colwise() - middle_.col(t)).colwise().norm().maxCoeff();
  }
}

// Möller and Trumbore: where the ray meets the plane, in the triangle's own coordinates.
bool SelfCover::Blocks(const Eigen::Vector3d& eye, const Eigen::Vector3d& point, double clearance,
                       const std::vector<int>& triangles) const {
  const double distance = (point - eye).norm();
  const Eigen::Vector3d ray = (point - eye) / distance;
  for (const int t : triangles) {
    const Eigen::Vector3d a = corners_.col(3 * t);
    const Eigen::Vector3d ab = corners_.col(3 * t + 1) - a, ac = corners_.col(3 * t + 2) - a;
    const Eigen::Vector3d p = ray.cross(ac);
    const double determinant = ab.dot(p);
    if (determinant == 0) continue;  // seen edge on
    const Eigen::Vector3d from = eye - a;
    const double u = from.dot(p) / determinant;
    if (!(u >= 0 && u <= 1)) continue;
    const Eigen::Vector3d q = from.cross(ab);
    const double v = ray.dot(q) / determinant;
    if (!(v >= 0 && u + v <= 1)) continue;
    const double along = ac.dot(q) / determinant;
    if (along > 0 && along < distance - clearance) return true;
  }
  return false;
}

bool SelfCover::Covers(const Eigen::Vector3d& eye, const Eigen::Vector3d& point,
                       const Eigen::Vector3d& normal, double radius, double clearance) const {
  const double distance = (point - eye).norm();
  const Eigen::Vector3d ray = (point - eye) / distance;
  std::vector<int> near;  // triangles that a ray to the disc may meet
  for (int t = 0; t < surface_.num_triangles(); ++t) {
    const Eigen::Vector3d from = middle_.col(t) - eye;
    const double along = from.dot(ray);
    if (along < -radius_(t) || along > distance + radius_(t)) continue;
    const double reach = radius_(t) + radius;
    if (from.squaredNorm() - along * along <= reach * reach) near.push_back(t);
  }
  if (!Blocks(eye, point, clearance, near)) return false;
  const Eigen::Vector3d across = radius * normal.unitOrthogonal();
  const Eigen::Vector3d along = normal.cross(across);
  for (const Eigen::Vector3d& rim : {across, along}) {
    if (!Blocks(eye, point + rim, clearance, near)) return false;
    if (!Blocks(eye, point - rim, clearance, near)) return false;
  }
  return true;
}

}  // namespace softforce::pipeline
