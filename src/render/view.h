#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "softforce/camera/rig.h"

namespace softforce::render {

// From where the scene is seen, and how large its strokes are.
struct View {
  const camera::Camera* camera;
  Eigen::Isometry3d T_camera_robot;
  cv::Size size;    // px
  double unit = 1;  // px of this picture per px of a picture 1024 px high
  double text = 1;  // the same for letters, which must be read in small pictures too
};

struct Sight {
  cv::Point2d pixel;
  double inverse_depth = 0;  // 1/m
  bool visible = false;      // the lens shows the point, and its pixel is not absurdly far outside
};

// Where a point (m, robot frame) is seen; a point that is not finite is not visible.
Sight See(const View& view, const Eigen::Vector3d& p_robot);

}  // namespace softforce::render
