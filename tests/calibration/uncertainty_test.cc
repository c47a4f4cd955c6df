#include <gtest/gtest.h>

#include <array>
#include <random>

#include "calibration/quick_calibration.h"
#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

using softforce::testing::CalibrationWorld;
using softforce::testing::MakeStereoWorld;
using softforce::testing::See;
using testing::Quick;

// The definition of the projection uncertainty, sampled: a point at rest in each board's frame, put
// into the rig by where the boards are found, averaged, and projected by the calibrated camera.
Eigen::Vector2d SampledProjection(const CalibrationWorld& world, const Calibration& result, int c,
                                  const Eigen::Vector3d& p_camera) {
  const Eigen::Vector3d p_rig = world.rig.cameras[c].T_camera_rig.inverse() * p_camera;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (size_t v = 0; v < world.T_rig_board.size(); ++v) {
    mean += result.views[v].T_rig_board * (world.T_rig_board[v].inverse() * p_rig);
  }
  mean /= static_cast<double>(world.T_rig_board.size());
  const camera::Camera& camera = result.rig.cameras[c];
  return camera::Project(camera.lens, camera.T_camera_rig * mean).pixel;
}

TEST(Calibrate, ReportsTheScatterOfValuesAndOfTheProjection) {
  CalibrationWorld world = MakeStereoWorld(10);
  world.warp = {0.0002, -0.0003};
  std::mt19937 random(8);
  CalibrationOptions options = Quick();
  options.working_distance = 0.4;
  const std::vector<Eigen::Vector2d> places = {{0, 0}, {639.5, 511.5}, {1279, 511.5}};
  const std::array<int, 3> in_grid = {0, 4, 5};
  std::array<double, 3> sampled{}, reported{};  // px², of the right camera
  double squares = 0;                           // of the values' normalised errors
  int count = 0;
  for (int trial = 0; trial < 15; ++trial) {
    const Calibration result = Calibrate(See(world, 0.1, &random), options);
    ASSERT_TRUE(result.ok());
    for (double error : softforce::testing::NormalisedErrors(world, result)) {
      squares += error * error;
      ++count;
    }
    for (size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector3d ray =
          camera::UnprojectRay(world.rig.cameras[1].lens, places[i]).value();
      sampled[i] += (SampledProjection(world, result, 1, 0.4 * ray) - places[i]).squaredNorm();
      reported[i] += result.uncertainty[1].covariances[in_grid[i]].trace();
    }
  }
  // The mean of 390 squares, of which about a quarter are independent, scatters by 14 %.
  EXPECT_NEAR(squares / count, 1, 0.42);
  for (size_t i = 0; i < places.size(); ++i) {
    // A variance from 15 samples, in one direction mostly, scatters by 37 %.
    EXPECT_NEAR(sampled[i] / reported[i], 1, 0.9) << i;
  }
}

}  // namespace
}  // namespace softforce::calibration
