#pragma once

#include <Eigen/Geometry>

#include "softforce/camera/rig.h"
#include "softforce/camera/triangulate.h"

namespace softforce::testing {

// Two cameras 150 mm apart that turn in towards a point 0.45 m in front of the left one, with lens
// distortion.
inline camera::Rig MakeStereoRig() {
  camera::Rig rig;
  camera::Camera left;
  left.name = "left";
  left.width = 1280;
  left.height = 1024;
  left.lens = {1400, 1402, 641.3, 509.8, {-0.12, 0.08, 0.0006, -0.0004, 0, 0, 0, 0}};
  camera::Camera right = left;
  right.name = "right";
  right.lens.distortion = {-0.11, 0.07, -0.0005, 0.0007, 0, 0, 0, 0};
  right.T_camera_rig =
      Eigen::AngleAxisd(0.32, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(-0.15, 0.002, 0.01);
  rig.cameras = {left, right};
  return rig;
}

// Where each camera sees a point, with the given standard deviation in px.
inline std::vector<camera::PixelObservation> ProjectInto(const camera::Rig& rig,
                                                         const Eigen::Vector3d& p_rig,
                                                         double sigma_px = 0.05) {
  std::vector<camera::PixelObservation> pixels;
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    const camera::Camera& camera = rig.cameras[c];
    pixels.push_back({c, camera::Project(camera.lens, camera.T_camera_rig * p_rig).pixel,
                      sigma_px * sigma_px * Eigen::Matrix2d::Identity()});
  }
  return pixels;
}

}  // namespace softforce::testing
