#pragma once

#include <array>
#include <cmath>

#include "softforce/camera/rig.h"
#include "softforce/scene/scene.h"
#include "support/box_mesh.h"
#include "support/soft_bodies.h"

namespace softforce::testing {

// A sheet of silicone of 130 × 80 × 15 mm, clamped at one end, with 40 identical dots, a free force
// and one across it.
constexpr double kDotSpacing = 0.006;  // m
constexpr int kDotColumns = 8, kDotRows = 5;
constexpr double kDotDiameter = 3e-3;  // m

inline mesh::TetMesh MakeDottedSheet(const std::array<int, 3>& bricks) {
  return mesh::RaiseOrder(MakeBox(bricks[0], bricks[1], bricks[2], {0.13, 0.08, 0.015}));
}

inline scene::Scene DottedSheetScene() {
  scene::Scene scene;
  scene.file = "sheet";
  scene.materials[""] = {fem::MaterialModel::kNeoHookean, 290e3, 0.45};
  scene::FixedRegion clamp;
  clamp.box_min = Eigen::Vector3d::Zero();
  clamp.box_max = {1e-9, 0.08, 0.015};
  scene.fixed = {clamp};
  scene.markers.type = scene::MarkerType::kDot;
  scene.markers.size = kDotDiameter;
  for (int j = 0; j < kDotRows; ++j) {
    for (int i = 0; i < kDotColumns; ++i) {
      scene.markers.points.push_back(
          {i + kDotColumns * j, {0.078 + kDotSpacing * i, 0.028 + kDotSpacing * j, 0.015}});
    }
  }
  scene.forces.patch = 8e-3;
  scene.forces.candidates.resize(2);
  scene.forces.candidates[0].id = 0;
  scene.forces.candidates[0].position = {0.125, 0.05, 0.015};
  scene.forces.candidates[1].id = 1;
  scene.forces.candidates[1].position = {0.07, 0.01, 0.015};
  scene.forces.candidates[1].direction = scene::ForceDirection::kFixed;
  scene.forces.candidates[1].fixed_direction = Eigen::Vector3d::UnitZ();
  return scene;
}

// Two cameras that look down on the sheet at 30° from its normal.
inline camera::Rig DottedSheetRig() {
  camera::Rig rig;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d target(0.075, 0.04, 0);
    const Eigen::Vector3d eye = target + Eigen::Vector3d(side * 0.075, -0.45 * std::sin(M_PI / 6),
                                                         0.45 * std::cos(M_PI / 6));
    const Eigen::Vector3d z = (target - eye).normalized();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX().cross(z).cross(z).normalized() * -1;
    Eigen::Matrix3d R_camera_robot;
    R_camera_robot << x.transpose(), z.cross(x).transpose(), z.transpose();
    camera::Camera camera;
    camera.name = side < 0 ? "left" : "right";
    camera.width = 1280;
    camera.height = 1024;
    camera.lens = {1400, 1400, 639.5, 511.5};
    camera.T_camera_rig.linear() = R_camera_robot;
    camera.T_camera_rig.translation() = -(R_camera_robot * eye);
    rig.cameras.push_back(camera);
  }
  return rig;
}

}  // namespace softforce::testing
