#include "softforce/vision/dot_follower.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "softforce/base/input_error.h"
#include "vision/synthetic_picture.h"

namespace softforce::vision {
namespace {

using softforce::testing::PaintEllipse;
using softforce::testing::SyntheticScene;

cv::Mat PictureOf(const std::vector<Eigen::Vector2d>& dots, int seed) {
  SyntheticScene scene(500, 400, 90);
  for (const Eigen::Vector2d& at : dots) PaintEllipse({at, 16, 12, 0.4}, 200, &scene);
  std::mt19937 random(seed);
  return scene.TakePicture(2, random);
}

void ExpectSame(const std::vector<Dot>& a, const std::vector<Dot>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].centroid, b[i].centroid);
    EXPECT_EQ(a[i].covariance, b[i].covariance);
  }
}

TEST(DetectDotsIn, MeasuresADotExactlyAsInTheWholePicture) {
  const cv::Mat picture = PictureOf({{80, 90}, {300, 200}, {17, 300}}, 3);
  const std::vector<Dot> all = DetectDots(picture);
  ASSERT_EQ(all.size(), 3u);
  // Two overlap; one ends at the picture's edge.
  ExpectSame(
      DetectDotsIn(picture,
                   {{60, 70, 50, 50}, {65, 65, 45, 60}, {270, 180, 60, 40}, {-20, 270, 60, 60}}),
      all);
}

TEST(DetectDotsIn, LeavesOutADotThatTheAreaCuts) {
  const cv::Mat picture = PictureOf({{80, 90}, {300, 200}}, 3);
  EXPECT_TRUE(DetectDotsIn(picture, {{82, 60, 60, 60}, {270, 195, 60, 60}}).empty());
}

TEST(DotFollower, FindsNearDotsWhatTheWholePictureHas) {
  DotFollower follower;
  for (int i = 0; i < 8; ++i) {  // at 7 px per picture
    const cv::Mat picture = PictureOf({{80.0 + 7 * i, 90}, {300, 300.0 - 7 * i}, {420, 60}}, i);
    const std::vector<Dot> all = DetectDots(picture);
    ASSERT_EQ(all.size(), 3u);
    ExpectSame(follower.Detect(picture), all);
  }
  EXPECT_EQ(follower.whole_searches(), 1);
}

TEST(DotFollower, FindsADotThatJumpedInTheSamePicture) {
  DotFollower follower;
  for (int i = 0; i < 4; ++i) follower.Detect(PictureOf({{80, 90}, {300, 200}}, i));
  const cv::Mat picture = PictureOf({{80, 90}, {180, 320}}, 4);
  ExpectSame(follower.Detect(picture), DetectDots(picture));
  EXPECT_EQ(follower.whole_searches(), 2);
}

TEST(DotFollower, LosesNoDotThatMovesFastFromTheStart) {
  DotFollower follower;
  for (int i = 0; i < 6; ++i) {  // at 40 px per picture, more than is looked at around a dot
    const cv::Mat picture = PictureOf({{60.0 + 40 * i, 90}, {60.0 + 40 * i, 200}}, i);
    ASSERT_EQ(follower.Detect(picture).size(), 2u) << i;
  }
  EXPECT_LE(follower.whole_searches(), 3);  // then their speed is known
}

// Two dots move side by side, and one is covered for a while: it comes back 70 px from where it was
// last seen, where its neighbour's motion says.
TEST(DotFollower, FindsACoveredDotInThePictureInWhichItIsSeenAgain) {
  DotFollower follower;
  for (int i = 0; i < 17; ++i) {
    std::vector<Eigen::Vector2d> dots{{80.0 + 7 * i, 90}};
    if (i < 5 || i >= 15) dots.emplace_back(80.0 + 7 * i, 130);
    const cv::Mat picture = PictureOf(dots, i);
    ASSERT_EQ(follower.Detect(picture).size(), dots.size()) << i;
  }
  EXPECT_LE(follower.whole_searches(), 6);  // the start, the loss, after 1, 2, 4, 8 pictures
}

// Of 20 grey levels, where 15 are the least that counts.
TEST(DotFollower, DoesNotSearchTheWholePictureForAFaintDotThatComesAndGoes) {
  DotFollower follower;
  for (int i = 0; i < 12; ++i) {
    const bool shown = i < 4 || i >= 8;
    SyntheticScene scene(500, 400, 90);
    PaintEllipse({{80, 90}, 16, 12, 0.4}, 200, &scene);
    PaintEllipse({{80, 200}, 16, 12, 0.4}, 110, &scene);
    if (shown) PaintEllipse({{300, 200}, 16, 12, 0.4}, 110, &scene);
    std::mt19937 random(i);
    ASSERT_EQ(follower.Detect(scene.TakePicture(2, random)).size(), shown ? 3u : 2u) << i;
  }
  EXPECT_EQ(follower.whole_searches(), 1);
}

TEST(DotFollower, FindsANewDotAtTheNextWholeSearch) {
  DotFollowerOptions options;
  options.whole_interval = 5;
  DotFollower follower(options);
  for (int i = 0; i < 3; ++i) follower.Detect(PictureOf({{80, 90}}, i));
  const cv::Mat picture = PictureOf({{80, 90}, {300, 200}}, 3);
  int pictures = 1;
  while (follower.Detect(picture).size() < 2 && pictures < 10) ++pictures;
  EXPECT_LE(pictures, 5);
}

TEST(DotFollowerOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](const std::function<void(DotFollowerOptions&)>& change) {
    DotFollowerOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(DotFollowerOptions().Check());
  refuses([](DotFollowerOptions& o) { o.margin_share = -1; });
  refuses([](DotFollowerOptions& o) { o.min_margin = 3; });
  refuses([](DotFollowerOptions& o) { o.whole_interval = 0; });
  refuses([](DotFollowerOptions& o) { o.forget = 0; });
  refuses([](DotFollowerOptions& o) { o.most_of_whole = 1.1; });
}

}  // namespace
}  // namespace softforce::vision
