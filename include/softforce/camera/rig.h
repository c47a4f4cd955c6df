#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/lens.h"
#include "softforce/geometry/rigid.h"

namespace softforce::camera {

struct Camera {
  std::string name;
  int width = 0, height = 0;  // px
  Lens lens;
  Eigen::Isometry3d T_camera_rig = Eigen::Isometry3d::Identity();
  // s, by which its time stamps are late; standard deviation, 0 where it is not known.
  double time_offset_s = 0, time_offset_sd_s = 0;
};

// Cameras that stand fixed to each other.
struct Rig {
  std::vector<Camera> cameras;
  std::optional<Eigen::Isometry3d> T_rig_robot;  // where the rig stands, if the file says so
  // Of T_rig_robot, as of a vision::RigPose: of a small twist (m, rad) in the rig frame. Zero:
  // exact.
  geometry::Matrix6d T_rig_robot_covariance = geometry::Matrix6d::Zero();

  // The number of the camera called `name`, or nothing.
  std::optional<int> Find(const std::string& name) const;
};

}  // namespace softforce::camera
