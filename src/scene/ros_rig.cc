#include <algorithm>

#include "scene/rig_formats.h"
#include "scene/ros_camera_info.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

// camera_info says how a camera stands only within a rectified pair: R turns the camera's frame
// into the rectified one, and P shifts it along the baseline: P[0, 3] = fx' Tx.

Eigen::Isometry3d CameraFromRectified(const CameraInfo& info) {
  const Eigen::Vector3d shift(info.P[3] / info.P[0], info.P[7] / info.P[5], 0);
  return Rigid(info.R.transpose(), info.R.transpose() * shift);
}

// The rotation of all cameras whose x axis lies along the baseline of two, and whose view is
// between theirs. A baseline that is rather upright keeps its y axis there instead, as in OpenCV.
Eigen::Matrix3d RectifiedFromRig(const camera::Rig& rig) {
  const auto centre = [](const camera::Camera& camera) {
    return Eigen::Vector3d(camera.T_camera_rig.inverse().translation());
  };
  const Eigen::Vector3d baseline = (centre(rig.cameras[1]) - centre(rig.cameras[0])).normalized();
  const Eigen::Vector3d view =
      rig.cameras[0].T_camera_rig.linear().row(2) + rig.cameras[1].T_camera_rig.linear().row(2);
  const Eigen::Vector3d right = rig.cameras[0].T_camera_rig.linear().row(0);
  const Eigen::Vector3d down = rig.cameras[0].T_camera_rig.linear().row(1);
  Eigen::Matrix3d R;  // rows: the rectified axes in the rig's frame
  if (std::abs(baseline.dot(right)) >= std::abs(baseline.dot(down))) {
    R.row(0) = baseline * (baseline.dot(right) < 0 ? -1 : 1);
    R.row(1) = view.cross(R.row(0).transpose()).normalized();
  } else {
    R.row(1) = baseline * (baseline.dot(down) < 0 ? -1 : 1);
    R.row(0) = R.row(1).transpose().cross(view).normalized();
  }
  R.row(2) = R.row(0).cross(R.row(1));
  return R;
}

// The pinhole that both rectified pictures share: the mean of the two lenses, centred so that what
// was in the middle stays near it.
std::array<double, 3> SharedPinhole(const camera::Rig& rig, const Eigen::Matrix3d& R_rect_rig) {
  const double count = static_cast<double>(rig.cameras.size());
  double f = 0, cx = 0, cy = 0;
  for (const camera::Camera& camera : rig.cameras) {
    const std::array<double, 4> lens = NumbersOf(camera).intrinsics;
    f += (lens[0] + lens[1]) / 2 / count;
  }
  for (const camera::Camera& camera : rig.cameras) {
    const Eigen::Vector3d axis = R_rect_rig * camera.T_camera_rig.linear().row(2).transpose();
    cx += ((camera.width - 1) / 2.0 - f * axis.x() / axis.z()) / count;
    cy += ((camera.height - 1) / 2.0 - f * axis.y() / axis.z()) / count;
  }
  return {f, cx, cy};
}

CameraInfo InfoOf(const camera::Camera& camera) {
  CameraInfo info;
  info.camera = camera;
  const auto [fx, fy, cx, cy] = NumbersOf(camera).intrinsics;
  info.R.setIdentity();
  info.P = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
  return info;
}

std::vector<CameraInfo> RectifiedPair(const camera::Rig& rig) {
  const Eigen::Matrix3d R_rect_rig = RectifiedFromRig(rig);
  const auto [f, cx, cy] = SharedPinhole(rig, R_rect_rig);
  const Eigen::Vector3d origin = rig.cameras[0].T_camera_rig.inverse().translation();
  std::vector<CameraInfo> infos;
  for (const camera::Camera& camera : rig.cameras) {
    CameraInfo info = InfoOf(camera);
    info.R = R_rect_rig * camera.T_camera_rig.linear().transpose();
    const Eigen::Vector3d centre = camera.T_camera_rig.inverse().translation();
    const Eigen::Vector3d shift = R_rect_rig * (origin - centre);
    info.P = {f, 0, cx, f * shift.x(), 0, f, cy, f * shift.y(), 0, 0, 1, 0};
    infos.push_back(info);
  }
  return infos;
}

}  // namespace

camera::Rig ReadRosRig(const std::vector<YamlValue>& files) {
  std::vector<CameraInfo> infos;
  for (const YamlValue& file : files) infos.push_back(ReadCameraInfo(file));
  camera::Rig rig;
  const Eigen::Isometry3d T_first_rectified = CameraFromRectified(infos[0]);
  for (size_t c = 0; c < infos.size(); ++c) {
    camera::Camera camera = infos[c].camera;
    if (rig.Find(camera.name)) camera.name = infos[c].file_stem;
    if (rig.Find(camera.name)) {
      files[c].Fail("the camera \"" + camera.name + "\" is given twice, expected once");
    }
    if (c > 0) camera.T_camera_rig = CameraFromRectified(infos[c]) * T_first_rectified.inverse();
    if (c > 0 && !(camera.T_camera_rig.translation().norm() > 0)) {
      files[c].Fail("the projection matrix P has no baseline to the first camera",
                    "These cameras were calibrated one by one. Calibrate them together, for "
                    "example with: softforce calibrate --help");
    }
    rig.cameras.push_back(camera);
  }
  return rig;
}

std::vector<std::string> RosTexts(const camera::Rig& rig) {
  std::vector<CameraInfo> infos;
  if (rig.cameras.size() == 2) {
    infos = RectifiedPair(rig);
  } else {
    for (const camera::Camera& camera : rig.cameras) infos.push_back(InfoOf(camera));
  }
  std::vector<std::string> texts;
  for (const CameraInfo& info : infos) texts.push_back(CameraInfoText(info));
  return texts;
}

}  // namespace softforce::scene
