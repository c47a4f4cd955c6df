#pragma once

#include <Eigen/Geometry>
#include <random>
#include <string>
#include <vector>

#include "softforce/calibration/calibrate.h"

namespace softforce::testing {

// A chessboard with 9×6 inner corners, 20 mm apart.
inline std::vector<Eigen::Vector3d> MakeBoardPoints() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 9 * 6; ++i) points.emplace_back(0.02 * (i % 9), 0.02 * (i / 9), 0);
  return points;
}

// Cameras, and a board held before them.
struct CalibrationWorld {
  camera::Rig rig;
  std::vector<calibration::LensFit> lenses;  // to be fitted
  std::vector<Eigen::Vector3d> board = MakeBoardPoints();
  Eigen::Vector2d warp = Eigen::Vector2d::Zero();  // m, as Calibration::warp
  std::vector<Eigen::Isometry3d> T_rig_board;

  Eigen::Vector3d Bent(int id) const {
    const double s = (id % 9) / 8.0, t = (id / 9) / 5.0;
    return board[id] + Eigen::Vector3d(0, 0, 4 * (warp.x() * s * (1 - s) + warp.y() * t * (1 - t)));
  }
};

// How the board is held: its middle 0.25 to 0.45 m away, somewhere before the cameras, turned by up
// to `tilt` (rad) about any axis across the view, and in its plane.
inline Eigen::Isometry3d HoldBoard(double tilt, std::mt19937* random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double distance = 0.35 + 0.1 * unit(*random);
  const Eigen::Vector3d middle =
      distance * Eigen::Vector3d(0.22 * unit(*random), 0.18 * unit(*random), 1);
  const double direction = M_PI * unit(*random);
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
  const Eigen::AngleAxisd lean(tilt * std::abs(unit(*random)), axis);
  const Eigen::AngleAxisd turn(0.4 * unit(*random), Eigen::Vector3d::UnitZ());
  return Eigen::Translation3d(middle) * lean * turn * Eigen::Translation3d(-0.08, -0.05, 0);
}

// Two cameras, 110 mm apart, that turn in towards a point 0.4 m away.
inline CalibrationWorld MakeStereoWorld(int views, double tilt = 0.7, int seed = 1) {
  CalibrationWorld world;
  camera::Camera left;
  left.name = "left";
  left.width = 1280;
  left.height = 1024;
  left.lens = {1400, 1402, 641.3, 509.8, {-0.12, 0.08, 0.0006, -0.0004, 0.02}};
  camera::Camera right = left;
  right.name = "right";
  right.lens = {1390, 1391, 630.1, 520.4, {-0.11, 0.07, -0.0005, 0.0007, 0.01}};
  right.T_camera_rig =
      Eigen::AngleAxisd(0.27, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(-0.11, 0.002, 0.01);
  world.rig.cameras = {left, right};
  world.lenses.assign(2, calibration::LensFit::kBrownConrady5);
  std::mt19937 random(seed);
  for (int v = 0; v < views; ++v) world.T_rig_board.push_back(HoldBoard(tilt, &random));
  return world;
}

// What the cameras see, with noise of the given standard deviation (px, per axis), as stated in the
// covariances (0: none, and stated as 0.1 px).
inline calibration::CalibrationInput See(const CalibrationWorld& world, double sigma,
                                         std::mt19937* random) {
  calibration::CalibrationInput input;
  input.board = world.board;
  for (size_t c = 0; c < world.rig.cameras.size(); ++c) {
    const camera::Camera& camera = world.rig.cameras[c];
    input.cameras.push_back({camera.name, camera.width, camera.height, world.lenses[c]});
  }
  const double stated = sigma > 0 ? sigma : 0.1;
  std::normal_distribution<double> normal;
  for (const Eigen::Isometry3d& T_rig_board : world.T_rig_board) {
    calibration::CalibrationView view;
    view.name = "view " + std::to_string(input.views.size());
    for (const camera::Camera& camera : world.rig.cameras) {
      vision::BoardView seen;
      for (int id = 0; id < static_cast<int>(world.board.size()); ++id) {
        const auto at =
            camera::Project(camera.lens, camera.T_camera_rig * (T_rig_board * world.Bent(id)));
        if (!at.visible) continue;
        const double x = at.pixel.x() + sigma * normal(*random);
        const double y = at.pixel.y() + sigma * normal(*random);
        if (x < 0 || y < 0 || x > camera.width - 1 || y > camera.height - 1) continue;
        seen.ids.push_back(id);
        seen.pixels.emplace_back(x, y);
        seen.covariances.push_back(stated * stated * Eigen::Matrix2d::Identity());
      }
      view.seen.push_back(seen);
    }
    input.views.push_back(view);
  }
  return input;
}

// By how many standard deviations each of the values is off.
inline std::vector<double> NormalisedErrors(const CalibrationWorld& world,
                                            const calibration::Calibration& result) {
  using Kind = calibration::CalibratedValue::Kind;
  std::vector<double> errors;
  int index = 0;  // within its kind and camera
  for (size_t i = 0; i < result.values.size(); ++i) {
    const calibration::CalibratedValue& value = result.values[i];
    const bool starts = i == 0 || result.values[i - 1].kind != value.kind ||
                        result.values[i - 1].camera != value.camera;
    index = starts ? 0 : index + 1;
    if (value.kind == Kind::kWarp) {
      errors.push_back((value.value - world.warp(index)) / value.sd);
      continue;
    }
    const camera::Camera& truth = world.rig.cameras[value.camera];
    const camera::Camera& found = result.rig.cameras[value.camera];
    const double core[] = {truth.lens.fx, truth.lens.fy, truth.lens.cx, truth.lens.cy};
    double off = NAN;
    switch (value.kind) {
      case Kind::kIntrinsics:
        off = value.value - core[index];
        break;
      case Kind::kDistortion:
        off = value.value - truth.lens.distortion[index];
        break;
      case Kind::kRotation: {  // a turn about the camera's axes after the true rotation
        const Eigen::AngleAxisd turn(found.T_camera_rig.linear() *
                                     truth.T_camera_rig.linear().transpose());
        off = turn.angle() * turn.axis()(index);
        break;
      }
      case Kind::kTranslation:
        off = value.value - truth.T_camera_rig.translation()(index);
        break;
      case Kind::kWarp:
        break;
    }
    errors.push_back(off / value.sd);
  }
  return errors;
}

}  // namespace softforce::testing
