#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/quick_calibration.h"
#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

using softforce::testing::CalibrationWorld;
using softforce::testing::MakeStereoWorld;
using softforce::testing::See;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MakeFisheyeWorld;
using testing::Quick;
using testing::SeeWithoutNoise;
using Status = Calibration::Status;

// Largest distance between where the true and the calibrated lens see a direction, over what was
// seen of the picture, px.
double LensDifference(const camera::Lens& truth, const camera::Lens& found,
                      const Calibration& result) {
  double worst = 0;
  for (const PointResidual& residual : result.residuals) {
    const auto ray = camera::UnprojectRay(truth, residual.pixel);
    if (!ray) return INFINITY;
    worst = std::max(worst, (camera::Project(found, *ray).pixel - residual.pixel).norm());
  }
  return worst;
}

void ExpectTruth(const CalibrationWorld& world, const Calibration& result) {
  ASSERT_TRUE(result.ok()) << Name(result.status) << ": " << result.reason;
  EXPECT_EQ(result.outliers, 0);
  for (size_t c = 0; c < world.rig.cameras.size(); ++c) {
    const camera::Camera& truth = world.rig.cameras[c];
    const camera::Camera& found = result.rig.cameras[c];
    // Of data without noise, only rounding and where the iterations end are left.
    EXPECT_LT(LensDifference(truth.lens, found.lens, result), 1e-5) << truth.name;  // px
    const Eigen::Isometry3d off = found.T_camera_rig * truth.T_camera_rig.inverse();
    EXPECT_LT(off.translation().norm(), 1e-8) << truth.name;                 // m
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 1e-8) << truth.name;  // rad
  }
  EXPECT_LT((result.warp - world.warp).norm(), 1e-8);  // m
}

TEST(Calibrate, RecoversAStereoRigAndTheBoardsBend) {
  CalibrationWorld world = MakeStereoWorld(10);
  world.warp = {0.0004, -0.0002};
  ExpectTruth(world, Calibrate(SeeWithoutNoise(world), Quick()));
}

TEST(Calibrate, RecoversOneCamera) {
  CalibrationWorld world = MakeStereoWorld(8);
  world.rig.cameras.resize(1);
  world.lenses.resize(1);
  const Calibration result = Calibrate(SeeWithoutNoise(world), Quick());
  ExpectTruth(world, result);
  EXPECT_EQ(result.values.size(), 4 + 5 + 2);
}

TEST(Calibrate, RecoversEachLensModel) {
  CalibrationWorld world = MakeStereoWorld(10);
  camera::Lens& left = world.rig.cameras[0].lens;
  camera::Lens& right = world.rig.cameras[1].lens;
  left.distortion = {-0.2, 0.1, 0.001, -0.001};
  right.model = camera::LensModel::kKannalaBrandt;
  right.distortion = {0.05, -0.02, 0.003, 0.001};
  world.lenses = {LensFit::kBrownConrady4, LensFit::kKannalaBrandt};
  ExpectTruth(world, Calibrate(SeeWithoutNoise(world), Quick()));
}

TEST(Calibrate, RecoversAWideFisheye) {
  const CalibrationWorld world = MakeFisheyeWorld();
  const CalibrationInput input = SeeWithoutNoise(world);
  double widest = 0;
  for (const CalibrationView& view : input.views) {
    for (const Eigen::Vector2d& pixel : view.seen[0].pixels) {
      widest = std::max(
          widest, std::acos(camera::UnprojectRay(world.rig.cameras[0].lens, pixel).value().z()));
    }
  }
  ASSERT_GT(widest, M_PI / 2);  // rad; else this tests nothing wide
  ExpectTruth(world, Calibrate(input, Quick()));
}

// Agreement where points were seen: numerator and denominator of the rational model may trade.
TEST(Calibrate, RecoversTheRationalModelWhereItWasSeen) {
  CalibrationWorld world = MakeStereoWorld(12);
  world.lenses.assign(2, LensFit::kBrownConrady8);
  for (camera::Camera& camera : world.rig.cameras) {
    camera.lens.distortion = {0.3, -0.1, 0.0006, -0.0004, 0.02, 0.5, -0.05, 0.01};
  }
  const CalibrationInput input = SeeWithoutNoise(world);
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  for (int c = 0; c < 2; ++c) {
    // px; the weak prior on the rational terms is weighed against points stated as good to 0.1 px
    EXPECT_LT(LensDifference(world.rig.cameras[c].lens, result.rig.cameras[c].lens, result), 0.03);
  }
}

// Cameras 0 and 1 share views, and 1 and 2, but never 0 and 2.
CalibrationWorld MakeChain(CalibrationInput* input) {
  CalibrationWorld world = MakeStereoWorld(16);
  camera::Camera third = world.rig.cameras[0];
  third.name = "third";
  third.lens.fx = third.lens.fy = 1200;
  third.T_camera_rig = Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                       Eigen::Translation3d(0.11, 0.01, 0.02);
  world.rig.cameras.push_back(third);
  world.lenses.assign(3, LensFit::kBrownConrady5);
  *input = SeeWithoutNoise(world);
  for (int v = 0; v < 16; ++v) input->views[v].seen[v % 2 == 0 ? 2 : 0] = {};
  return world;
}

TEST(Calibrate, ConnectsCamerasThroughOthers) {
  CalibrationInput input;
  const CalibrationWorld world = MakeChain(&input);
  ExpectTruth(world, Calibrate(input, Quick()));
}

TEST(Calibrate, NamesTheGroupsOfCamerasThatNeverSeeTheBoardTogether) {
  CalibrationInput input;
  MakeChain(&input);
  for (int v = 1; v < 16; v += 2) {  // what cameras 1 and 2 shared
    CalibrationView alone = input.views[v];
    alone.seen[1] = {};
    input.views.push_back(alone);
    input.views[v].seen[2] = {};
  }
  const Calibration result = Calibrate(input, Quick());
  EXPECT_EQ(result.status, Status::kNotConnected);
  EXPECT_THAT(result.groups, ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
  EXPECT_THAT(result.reason, HasSubstr("{left, right} and {third}"));
  EXPECT_THAT(result.what_to_do, HasSubstr("at the same time"));
}

TEST(Calibrate, GivesTheSameBitsAgain) {
  std::mt19937 random(4);
  const CalibrationInput input = See(MakeStereoWorld(8), 0.1, &random);
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  const Calibration once = Calibrate(input, options);
  const Calibration again = Calibrate(input, options);
  ASSERT_TRUE(once.ok());
  for (size_t i = 0; i < once.values.size(); ++i) {
    EXPECT_EQ(once.values[i].value, again.values[i].value);
    EXPECT_EQ(once.values[i].sd, again.values[i].sd);
  }
  EXPECT_EQ(once.hold_out.rms_px, again.hold_out.rms_px);
}

}  // namespace
}  // namespace softforce::calibration
