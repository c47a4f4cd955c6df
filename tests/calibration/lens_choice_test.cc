#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "calibration/quick_calibration.h"
#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

using softforce::testing::CalibrationWorld;
using softforce::testing::MakeStereoWorld;
using softforce::testing::See;
using ::testing::ElementsAre;
using testing::MakeFisheyeWorld;
using testing::Quick;

TEST(Calibrate, ChoosesTheLensModelByHeldOutViews) {
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  std::mt19937 random(4);
  CalibrationInput input = See(MakeFisheyeWorld(), 0.1, &random);
  input.cameras[0].lens.reset();

  const Calibration result = Calibrate(input, options);

  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_THAT(result.lenses, ElementsAre(LensFit::kKannalaBrandt));
  ASSERT_EQ(result.trials.size(), 4);
  EXPECT_EQ(result.trials[3].hold_out_px, result.hold_out.rms_px);
}

// A lens that all models fit: the one with the fewest parameters.
TEST(Calibrate, PrefersTheLensModelWithFewerParameters) {
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  std::mt19937 random(4);
  CalibrationWorld world = MakeStereoWorld(9);
  world.rig.cameras.resize(1);
  world.lenses.resize(1);
  world.rig.cameras[0].lens.distortion = {-0.1, 0.05, 0.0005, -0.0003};
  CalibrationInput input = See(world, 0.1, &random);
  input.cameras[0].lens.reset();
  EXPECT_THAT(Calibrate(input, options).lenses, ElementsAre(LensFit::kBrownConrady4));
}

TEST(Calibrate, ChoosesTheSimplestLensModelIfNoViewCanBeHeldOut) {
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(3), 0.02, &random);
  for (CameraToCalibrate& camera : input.cameras) camera.lens.reset();
  const Calibration result = Calibrate(input, options);
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_EQ(result.hold_out.folds, 0);
  EXPECT_THAT(result.lenses, ElementsAre(LensFit::kBrownConrady4, LensFit::kBrownConrady4));
}

}  // namespace
}  // namespace softforce::calibration
