#pragma once

#include <cmath>
#include <random>

#include "support/calibration_world.h"

namespace softforce::calibration::testing {

// Without held-out views, and with a coarse map of the uncertainty.
inline CalibrationOptions Quick() {
  CalibrationOptions options;
  options.max_folds = 0;
  options.uncertainty_columns = options.uncertainty_rows = 3;
  return options;
}

inline CalibrationInput SeeWithoutNoise(const softforce::testing::CalibrationWorld& world) {
  std::mt19937 random(1);
  return softforce::testing::See(world, 0, &random);
}

// One camera that sees beyond 90°, and the board all around it.
inline softforce::testing::CalibrationWorld MakeFisheyeWorld() {
  softforce::testing::CalibrationWorld world = softforce::testing::MakeStereoWorld(25, 0.9, 3);
  world.rig.cameras.resize(1);
  world.lenses = {LensFit::kKannalaBrandt};
  world.rig.cameras[0].lens = {
      330, 331, 641.3, 509.8, {0.03, -0.01, 0.003, -0.0006}, camera::LensModel::kKannalaBrandt};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (Eigen::Isometry3d& T : world.T_rig_board) {
    const double direction = M_PI * unit(random);
    const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
    T = Eigen::AngleAxisd(1.2 * std::abs(unit(random)), axis) * Eigen::Translation3d(0, 0, -0.2) *
        T;
  }
  return world;
}

}  // namespace softforce::calibration::testing
