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
using ::testing::HasSubstr;
using testing::Quick;
using testing::SeeWithoutNoise;
using Status = Calibration::Status;

TEST(Calibrate, SaysThatTheBoardNeverTilted) {
  std::mt19937 random(4);
  CalibrationWorld world = MakeStereoWorld(10, 0);
  world.rig.cameras.resize(1);
  world.lenses.resize(1);
  const Calibration result = Calibrate(See(world, 0.1, &random), Quick());
  EXPECT_EQ(result.status, Status::kUndetermined) << Name(result.status);
  EXPECT_THAT(result.what_to_do, HasSubstr("tilted by 30 to 45 degrees"));
}

TEST(Calibrate, SaysThatThereAreTooFewViews) {
  CalibrationInput input = SeeWithoutNoise(MakeStereoWorld(4));
  input.views[0].seen[1] = {};
  input.views[1].seen[1].ids.resize(5);
  input.views[1].seen[1].pixels.resize(5);
  input.views[1].seen[1].covariances.resize(5);
  const Calibration result = Calibrate(input, Quick());
  EXPECT_EQ(result.status, Status::kTooFewViews);
  EXPECT_EQ(result.reason,
            "camera \"right\" has 2 usable pictures of the board, expected at least 3");
}

TEST(Calibrate, SaysThatItIsAnotherBoard) {
  CalibrationInput input = SeeWithoutNoise(MakeStereoWorld(8));
  // The points counted in rows of six instead of nine.
  for (int id = 0; id < 54; ++id) input.board[id] = {0.02 * (id % 6), 0.02 * (id / 6), 0};
  const Calibration result = Calibrate(input, Quick());
  EXPECT_TRUE(result.status == Status::kBoardMismatch || result.status == Status::kNoStart)
      << Name(result.status);
  EXPECT_THAT(result.what_to_do, HasSubstr("the board given is the one in the pictures"));
}

TEST(Calibrate, StopsWhenAsked) {
  const std::atomic<bool> stop = true;
  CalibrationOptions options = Quick();
  options.stop = &stop;
  EXPECT_EQ(Calibrate(SeeWithoutNoise(MakeStereoWorld(5)), options).status, Status::kStopped);
}

}  // namespace
}  // namespace softforce::calibration
