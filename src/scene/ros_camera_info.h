#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "scene/yaml_reader.h"
#include "softforce/camera/rig.h"

namespace softforce::scene {

// A camera as ROS's sensor_msgs/CameraInfo has it.
struct CameraInfo {
  camera::Camera camera;       // T_camera_rig is left alone
  std::string file_stem;       // "left" of left.yaml
  Eigen::Matrix3d R;           // from the camera's frame to the rectified one
  std::array<double, 12> P{};  // 3×4, row by row, px and px·m
};

// The file of the calibration tools (camera_matrix: {rows, cols, data}), or the message itself as
// `ros2 topic echo` prints it (k, d, r, p; capital letters in ROS 1).
CameraInfo ReadCameraInfo(const YamlValue& file);

// The same file of the calibration tools.
std::string CameraInfoText(const CameraInfo& info);

}  // namespace softforce::scene
