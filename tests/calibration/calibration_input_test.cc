#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "softforce/base/input_error.h"
#include "support/calibration_world.h"

namespace softforce::calibration {
namespace {

using ::testing::HasSubstr;

CalibrationInput GoodInput() {
  std::mt19937 random(1);
  return softforce::testing::See(softforce::testing::MakeStereoWorld(3), 0.1, &random);
}

std::string Refusal(const std::function<void(CalibrationInput*)>& spoil) {
  CalibrationInput input = GoodInput();
  spoil(&input);
  try {
    input.Check();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CalibrationInput, IsAcceptedIfGood) {
  EXPECT_EQ(Refusal([](CalibrationInput*) {}), "accepted");
}

TEST(CalibrationInput, RefusesPointsOutsideThePicture) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->cameras[1].width = 320; }),
              ::testing::AllOf(HasSubstr("camera \"right\""), HasSubstr("outside of 320 x 1024 px"),
                               HasSubstr("must have its resolution")));
}

TEST(CalibrationInput, RefusesIdsThatTheBoardHasNot) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->board.resize(20); }),
              HasSubstr("but the board has 20 points"));
}

TEST(CalibrationInput, RefusesAPointTwice) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) {
                input->views[2].seen[0].ids[1] = input->views[2].seen[0].ids[0];
              }),
              HasSubstr("view \"view 2\", camera \"left\": got point 0 twice"));
}

TEST(CalibrationInput, RefusesACovarianceThatIsNone) {
  EXPECT_THAT(
      Refusal([](CalibrationInput* input) { input->views[0].seen[0].covariances[0].setZero(); }),
      HasSubstr("covariance is not positive definite"));
}

TEST(CalibrationInput, RefusesListsOfUnequalLength) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->views[0].seen[0].pixels.pop_back(); }),
              HasSubstr("expected as many of each"));
}

TEST(CalibrationInput, RefusesABoardThatIsNotFlat) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->board[3].z() = 0.01; }),
              HasSubstr("plane z = 0"));
}

TEST(CalibrationInput, RefusesABoardOfThreePoints) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->board.resize(3); }),
              HasSubstr("got 3 points"));
}

TEST(CalibrationInput, RefusesAViewOfAnotherNumberOfCameras) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->views[1].seen.resize(1); }),
              HasSubstr("got what 1 cameras saw, expected 2"));
}

TEST(CalibrationInput, RefusesNoCameras) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->cameras.clear(); }),
              HasSubstr("got no cameras"));
}

TEST(CalibrationInput, RefusesACameraWithoutASize) {
  EXPECT_THAT(Refusal([](CalibrationInput* input) { input->cameras[0].height = 0; }),
              HasSubstr("got a picture of 1280 x 0 px"));
}

std::string OptionRefusal(const std::function<void(CalibrationOptions*)>& spoil) {
  CalibrationOptions options;
  spoil(&options);
  try {
    options.Check();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CalibrationOptions, AreRefusedOutOfRange) {
  using Options = CalibrationOptions;
  EXPECT_EQ(OptionRefusal([](Options*) {}), "accepted");
  EXPECT_THAT(OptionRefusal([](Options* o) { o->min_views = 0; }), HasSubstr("min_views"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->min_points = 3; }), HasSubstr("min_points"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->outlier_probability = 0; }),
              HasSubstr("outlier_probability"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->working_distance = -1; }),
              HasSubstr("working_distance"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->uncertainty_rows = 1; }),
              HasSubstr("uncertainty_rows"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->coverage_columns = 0; }),
              HasSubstr("coverage_columns"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->max_folds = 1; }), HasSubstr("max_folds"));
  EXPECT_THAT(OptionRefusal([](Options* o) { o->max_relative_sd = 0; }),
              HasSubstr("max_relative_sd"));
}

TEST(Calibrate, RefusesToChooseALensWithoutHeldOutViews) {
  CalibrationInput input = GoodInput();
  input.cameras[0].lens.reset();
  CalibrationOptions options;
  options.max_folds = 0;
  EXPECT_THROW(Calibrate(input, options), base::InputError);
}

}  // namespace
}  // namespace softforce::calibration
