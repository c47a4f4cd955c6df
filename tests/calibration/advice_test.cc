#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "calibration/quick_calibration.h"
#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

using softforce::testing::CalibrationWorld;
using softforce::testing::MakeStereoWorld;
using softforce::testing::See;
using testing::Quick;

bool Advises(const Calibration& result, Advice::Kind kind, const std::string& words) {
  return std::any_of(result.advice.begin(), result.advice.end(), [&](const Advice& advice) {
    return advice.kind == kind && advice.finding.find(words) != std::string::npos;
  });
}

TEST(Calibrate, AdvisesWhereTheBoardWasNotSeen) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(12), 0.05, &random);
  for (CalibrationView& view : input.views) {
    vision::BoardView kept;
    const vision::BoardView& seen = view.seen[0];
    for (int i = 0; i < seen.size(); ++i) {
      if (seen.pixels[i].x() < 300) continue;
      kept.ids.push_back(seen.ids[i]);
      kept.pixels.push_back(seen.pixels[i]);
      kept.covariances.push_back(seen.covariances[i]);
    }
    view.seen[0] = kept;
  }
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(Advises(result, Advice::Kind::kEdgeNotCovered, "left: no board near the left edge"));
  EXPECT_FALSE(
      Advises(result, Advice::Kind::kEdgeNotCovered, "right: no board near the left edge"));
  EXPECT_EQ(result.cameras[0].coverage.leftCols(1).sum(), 0);
  EXPECT_EQ(result.cameras[0].coverage.sum(), result.cameras[0].points);
}

TEST(Calibrate, AdvisesToTilt) {
  std::mt19937 random(4);
  const Calibration result = Calibrate(See(MakeStereoWorld(12, 0.1), 0.02, &random), Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(Advises(result, Advice::Kind::kFewViews, "") == false);
  EXPECT_TRUE(Advises(result, Advice::Kind::kUncertainFocal, "") ||
              Advises(result, Advice::Kind::kLittleTilt, ""));
}

TEST(Calibrate, AdvisesToShareViews) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(16), 0.05, &random);
  for (int v = 2; v < 16; ++v) input.views[v].seen[v % 2] = {};
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(Advises(result, Advice::Kind::kFewSharedViews, "right sees the board together"));
}

TEST(Calibrate, AdvisesOnABentBoard) {
  CalibrationWorld world = MakeStereoWorld(10);
  world.warp = {0.001, 0};
  std::mt19937 random(4);
  const Calibration result = Calibrate(See(world, 0.05, &random), Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_NEAR(result.warp.x(), 1e-3, 3e-5);  // m; its standard deviation is 1e-5
  EXPECT_TRUE(Advises(result, Advice::Kind::kLargeWarp, "the board bends by"));
}

}  // namespace
}  // namespace softforce::calibration
