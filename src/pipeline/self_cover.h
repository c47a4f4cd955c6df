#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::pipeline {

// What the body itself hides from a point of view: rays against the flat triangles of its surface.
class SelfCover {
 public:
  // `x`: where the nodes stand, 3×N, m. The surface must outlive it.
  SelfCover(const mesh::Surface& surface, const Eigen::Matrix3Xd& x);

  // Whether the body stands between `eye` and all of a disc of this radius (m) about `point`: its
  // middle and four places of its rim. What is nearer to the disc than `clearance` (m) is the
  // disc's own ground.
  bool Covers(const Eigen::Vector3d& eye, const Eigen::Vector3d& point,
              const Eigen::Vector3d& normal, double radius, double clearance) const;

 private:
  bool Blocks(const Eigen::Vector3d& eye, const Eigen::Vector3d& point, double clearance,
              const std::vector<int>& triangles) const;

  const mesh::Surface& surface_;
  Eigen::Matrix3Xd corners_;  // m, three columns per triangle
  Eigen::Matrix3Xd middle_;   // m, of a ball around each triangle
  Eigen::VectorXd radius_;    // m
};

}  // namespace softforce::pipeline
