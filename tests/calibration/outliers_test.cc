#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "calibration/quick_calibration.h"
#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

using softforce::testing::MakeStereoWorld;
using softforce::testing::See;
using testing::Quick;

// Points moved across the picture, by hundreds of pixels: every fifth of the first ten in each.
std::vector<std::array<int, 3>> Poison(CalibrationInput* input) {
  std::vector<std::array<int, 3>> poisoned;
  for (int v = 0; v < static_cast<int>(input->views.size()); ++v) {
    for (int c = 0; c < 2; ++c) {
      vision::BoardView& seen = input->views[v].seen[c];
      for (int i = (v + c) % 5; i < std::min(10, seen.size()); i += 5) {
        seen.pixels[i].x() = std::fmod(seen.pixels[i].x() + 640, 1279);
        seen.pixels[i].y() = std::fmod(seen.pixels[i].y() + 512, 1023);
        poisoned.push_back({v, c, seen.ids[i]});
      }
    }
  }
  return poisoned;
}

TEST(Calibrate, OutliersDoNotChangeTheAnswer) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(10), 0.05, &random);
  CalibrationInput poisoned = input;
  const std::vector<std::array<int, 3>> bad = Poison(&poisoned);
  for (const auto& [v, c, id] : bad) {  // the same without the points
    vision::BoardView& seen = input.views[v].seen[c];
    const auto at = std::find(seen.ids.begin(), seen.ids.end(), id) - seen.ids.begin();
    seen.ids.erase(seen.ids.begin() + at);
    seen.pixels.erase(seen.pixels.begin() + at);
    seen.covariances.erase(seen.covariances.begin() + at);
  }

  const Calibration clean = Calibrate(input, Quick());
  const Calibration result = Calibrate(poisoned, Quick());

  ASSERT_TRUE(clean.ok() && result.ok());
  EXPECT_EQ(result.outliers, clean.outliers + static_cast<int>(bad.size()));
  for (const PointResidual& residual : result.residuals) {
    const std::array<int, 3> key = {residual.view, residual.camera, residual.id};
    const bool is_bad = std::find(bad.begin(), bad.end(), key) != bad.end();
    EXPECT_TRUE(residual.outlier || !is_bad);
  }
  for (size_t i = 0; i < clean.values.size(); ++i) {
    // in standard deviations; the floor is found among all points, and weighs them very little
    // differently
    EXPECT_NEAR(result.values[i].value, clean.values[i].value, 0.02 * clean.values[i].sd)
        << clean.values[i].name;
  }
}

TEST(Calibrate, LeavesOutAPictureThatIsNotOfTheView) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(10), 0.05, &random);
  vision::BoardView& wrong = input.views[3].seen[1];
  for (int& id : wrong.ids) id = 53 - id;  // as if the board had been turned by half a turn
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(result.views[3].pictures[1].left_out);
  EXPECT_FALSE(result.views[3].pictures[0].left_out);
  EXPECT_TRUE(std::any_of(result.advice.begin(), result.advice.end(), [](const Advice& advice) {
    return advice.kind == Advice::Kind::kPictureLeftOut && advice.camera == 1;
  }));
}

TEST(Calibrate, RaisesNoiseThatIsStatedTooLowToWhatTheFitLeaves) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(12), 0.1, &random);
  for (CalibrationView& view : input.views) {
    for (vision::BoardView& seen : view.seen) {
      for (Eigen::Matrix2d& covariance : seen.covariances) covariance *= 1e-2;
    }
  }
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok());
  // px; the floor to 0.01 px gives 0.1; of 1200 points the noise is known to 2 %, its median to 3 %
  EXPECT_NEAR(result.floor_px, 0.0995, 0.009);
  EXPECT_NEAR(result.noise_px, 0.1, 0.006);
  EXPECT_NEAR(result.noise_factor, 1, 0.1);
}

}  // namespace
}  // namespace softforce::calibration
