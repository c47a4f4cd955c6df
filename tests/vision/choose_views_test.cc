#include "softforce/vision/choose_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Status = ViewVerdict::Status;

// A view of twelve points on cells of 30 px, moved along x, px.
BoardDetection View(double x, double blur = 0.8) {
  BoardDetection detection;
  detection.status = BoardDetection::Status::kOk;
  detection.cell = 30;
  detection.blur = blur;
  for (int k = 0; k < 12; ++k) {
    detection.view.ids.push_back(k);
    detection.view.pixels.emplace_back(x + 30 * (k % 4), 30 * (k / 4));
    detection.view.covariances.push_back(Eigen::Matrix2d::Identity());
  }
  return detection;
}

BoardDetection NoView() {
  BoardDetection detection;
  detection.status = BoardDetection::Status::kNotFound;
  detection.reason = "no board";
  return detection;
}

std::vector<Status> OfFirstCamera(const std::vector<std::vector<ViewVerdict>>& verdicts) {
  std::vector<Status> statuses;
  for (const auto& set : verdicts) statuses.push_back(set.front().status);
  return statuses;
}

TEST(ChooseViews, KeepsOneOfABoardAtRest) {
  const auto verdicts = ChooseViews({{View(0)}, {View(1)}, {View(2)}, {View(60)}, {View(61)}});
  EXPECT_THAT(OfFirstCamera(verdicts),
              ElementsAre(Status::kKept, Status::kDuplicate, Status::kDuplicate, Status::kKept,
                          Status::kDuplicate));
  EXPECT_THAT(verdicts[4][0].reason, HasSubstr("moment 3"));
  EXPECT_THAT(verdicts[4][0].reason, HasSubstr("0.03 cells"));
}

TEST(ChooseViews, KeepsTheSharperOfTwoAlike) {
  const auto verdicts = ChooseViews({{View(0, 1.1)}, {View(1, 0.8)}});
  EXPECT_THAT(OfFirstCamera(verdicts), ElementsAre(Status::kDuplicate, Status::kKept));
}

TEST(ChooseViews, LeavesOutWhatIsBlurredAgainstTheCamerasOtherViews) {
  const auto verdicts = ChooseViews({{View(0)}, {View(60)}, {View(120, 1.5)}, {View(180)}});
  EXPECT_THAT(OfFirstCamera(verdicts),
              ElementsAre(Status::kKept, Status::kKept, Status::kBlurred, Status::kKept));
  EXPECT_THAT(verdicts[2][0].reason, HasSubstr("1.5 px"));
}

TEST(ChooseViews, LeavesOutWhatIsBlurredAgainstTheBoardsCells) {
  const auto verdicts = ChooseViews({{View(0, 5)}, {View(60, 5)}});  // 5 px of 30
  EXPECT_THAT(OfFirstCamera(verdicts), ElementsAre(Status::kBlurred, Status::kBlurred));
  EXPECT_THAT(verdicts[0][0].reason, HasSubstr("0.17 of a cell"));
}

TEST(ChooseViews, JudgesEachCameraByItsOwnSharpness) {
  // The second camera is softer throughout.
  const auto verdicts =
      ChooseViews({{View(0), View(0, 2)}, {View(60), View(60, 2)}, {View(120), View(120, 4)}});
  EXPECT_TRUE(verdicts[0][1].kept());
  EXPECT_TRUE(verdicts[2][0].kept());
  EXPECT_EQ(verdicts[2][1].status, Status::kBlurred);
}

TEST(ChooseViews, KeepsAMomentThatIsNewInOneCamera) {
  const auto verdicts = ChooseViews({{View(0), View(0)}, {View(1), View(60)}, {View(0), NoView()}});
  EXPECT_TRUE(verdicts[1][0].kept());
  EXPECT_TRUE(verdicts[1][1].kept());
  EXPECT_EQ(verdicts[2][0].status, Status::kDuplicate);
  EXPECT_EQ(verdicts[2][1].status, Status::kNoBoard);
  EXPECT_EQ(verdicts[2][1].reason, "no board");
}

TEST(ChooseViews, TakesOtherPointsOfTheBoardAsNew) {
  BoardDetection part = View(0);
  for (int k = 0; k < 7; ++k) part.view.ids[k] += 12;
  std::sort(part.view.ids.begin(), part.view.ids.end());
  const auto verdicts = ChooseViews({{View(0)}, {part}});
  EXPECT_THAT(OfFirstCamera(verdicts), ElementsAre(Status::kKept, Status::kKept));
}

TEST(ChooseViews, KeepsTheMostDifferentIfThereAreTooMany) {
  ChooseOptions options;
  options.max_sets = 3;
  const auto verdicts =
      ChooseViews({{View(0)}, {View(10)}, {View(200)}, {View(210)}, {View(100)}}, options);
  EXPECT_THAT(OfFirstCamera(verdicts), ElementsAre(Status::kKept, Status::kSurplus,
                                                   Status::kSurplus, Status::kKept, Status::kKept));
  EXPECT_THAT(verdicts[1][0].reason, HasSubstr("more than 3"));
}

TEST(ChooseViews, HasNothingToChooseFromNothing) { EXPECT_TRUE(ChooseViews({}).empty()); }

TEST(ViewChooser, TakesTheBoardWhereItRests) {
  ViewChooser chooser;
  std::vector<Status> statuses;
  for (const double x : {0.0, 1.0, 30.0, 60.0, 61.0, 62.0}) {
    statuses.push_back(chooser.Add({View(x)}).front().status);
  }
  EXPECT_THAT(statuses, ElementsAre(Status::kKept, Status::kDuplicate, Status::kMoving,
                                    Status::kMoving, Status::kKept, Status::kDuplicate));
  EXPECT_EQ(chooser.kept().size(), 2u);
}

TEST(ViewChooser, LeavesOutBlurredViewsOfOneCamera) {
  ViewChooser chooser;
  for (const double x : {0.0, 2.0}) chooser.Add({View(x), View(x)});
  const auto verdicts = chooser.Add({View(0), View(0, 2)});
  EXPECT_EQ(verdicts[1].status, Status::kBlurred);
  EXPECT_TRUE(chooser.kept()[0][1].ok());
  EXPECT_FALSE(chooser.Add({NoView(), NoView()})[0].kept());
}

TEST(ChooseOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](auto change) {
    ChooseOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(ChooseOptions().Check());
  refuses([](ChooseOptions& o) { o.max_blur = 0; });
  refuses([](ChooseOptions& o) { o.max_blur_ratio = 0.9; });
  refuses([](ChooseOptions& o) { o.min_motion = -1; });
  refuses([](ChooseOptions& o) { o.max_speed = 0; });
  refuses([](ChooseOptions& o) { o.max_sets = -1; });
}

}  // namespace
}  // namespace softforce::vision
