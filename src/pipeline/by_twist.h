#pragma once

#include <Eigen/Core>

#include "softforce/geometry/rigid.h"

namespace softforce::pipeline {

// The derivative of a point that moves with the robot frame, by the twist of the rig's place: p +
// translation + rotation × p.
inline Eigen::Matrix<double, 3, 6> ByTwist(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -geometry::Skew(p);
  return jacobian;
}

}  // namespace softforce::pipeline
