#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "softforce/base/input_error.h"
#include "softforce/vision/dots.h"
#include "vision/synthetic_picture.h"

namespace softforce::vision {
namespace {

using softforce::testing::PaintBox;
using softforce::testing::PaintEllipse;
using softforce::testing::SyntheticScene;

constexpr double kGround = 60;  // grey levels
constexpr double kPaint = 190;  // grey levels

std::vector<Dot> DetectIn(const SyntheticScene& scene, const DotOptions& options = {}) {
  std::mt19937 random(5);
  return DetectDots(scene.TakePicture(2, random), options);
}

TEST(DetectDots, FindsNothingWhereThereIsNothing) {
  std::mt19937 random(5);
  EXPECT_TRUE(DetectDots(cv::Mat(200, 200, CV_8U, cv::Scalar(0))).empty());
  EXPECT_TRUE(DetectDots(cv::Mat(200, 200, CV_8U, cv::Scalar(255))).empty());
  EXPECT_TRUE(DetectDots(cv::Mat()).empty());
  EXPECT_TRUE(DetectIn(SyntheticScene(200, 200, 128)).empty());
  EXPECT_TRUE(DetectDots(SyntheticScene(5, 3, 128).TakePicture(40, random)).empty());
}

TEST(DetectDots, DoesNotTakeASquareForADot) {
  for (const double side : {15, 24, 40}) {
    SyntheticScene scene(200, 200, kGround);
    PaintBox({80.3, 80.6}, {80.3 + side, 80.6 + side}, kPaint, &scene);
    EXPECT_TRUE(DetectIn(scene).empty()) << side;
  }
}

TEST(DetectDots, DoesNotTakeABarForADot) {
  SyntheticScene scene(200, 200, kGround);
  PaintBox({60, 90}, {130, 98}, kPaint, &scene);
  EXPECT_TRUE(DetectIn(scene).empty());
}

TEST(DetectDots, LeavesOutWhatIsTooLargeOrTooSmall) {
  SyntheticScene scene(400, 300, kGround);
  PaintEllipse({{120, 150}, 100, 100, 0}, kPaint, &scene);
  PaintEllipse({{300, 150}, 2.5, 2.5, 0}, kPaint, &scene);
  EXPECT_TRUE(DetectIn(scene).empty());
}

TEST(DetectDots, RefusesADotCutByThePicturesEdge) {
  for (const double x : {-4.0, 0.0, 4.0, 7.0}) {
    SyntheticScene scene(200, 200, kGround);
    PaintEllipse({{x, 100}, 16, 16, 0}, kPaint, &scene);
    PaintEllipse({{199 - x, 60}, 16, 16, 0}, kPaint, &scene);
    PaintEllipse({{60, x}, 16, 16, 0}, kPaint, &scene);
    PaintEllipse({{100, 199 - x}, 16, 16, 0}, kPaint, &scene);
    EXPECT_TRUE(DetectIn(scene).empty()) << x;
  }
}

TEST(DetectDots, NeverMakesOneOfTwoDots) {
  for (const double gap : {0.5, 1.0, 2.0, 3.0, 6.0}) {
    const Eigen::Vector2d first(80.2, 90.4);
    const Eigen::Vector2d second = first + Eigen::Vector2d(14 + gap, 3);
    SyntheticScene scene(200, 200, kGround);
    PaintEllipse({first, 14, 14, 0}, kPaint, &scene);
    PaintEllipse({second, 14, 14, 0}, kPaint, &scene);

    const auto dots = DetectIn(scene);

    // A neighbour spoils the ring from which the ground is taken, but no dot may lie anywhere else.
    for (const Dot& dot : dots) {
      const double error = std::min((dot.centroid - first).norm(), (dot.centroid - second).norm());
      EXPECT_LT(error, 0.5) << gap;  // px
    }
    if (gap >= 2) {
      EXPECT_EQ(dots.size(), 2u) << gap;
    }
  }
}

TEST(DetectDots, IsNotPulledByANeighbour) {
  for (const double gap : {3.0, 4.0, 6.0}) {
    const Eigen::Vector2d first(80.2, 90.4);
    SyntheticScene scene(200, 200, kGround);
    PaintEllipse({first, 14, 14, 0}, kPaint, &scene);
    PaintEllipse({first + Eigen::Vector2d(14 + gap, 0), 14, 14, 0}, kPaint, &scene);

    const auto dots = DetectIn(scene);

    ASSERT_EQ(dots.size(), 2u) << gap;
    const double error =
        std::min((dots[0].centroid - first).norm(), (dots[1].centroid - first).norm());
    EXPECT_LT(error, 0.05) << gap;  // px; five standard deviations
  }
}

TEST(DetectDots, FindsOnlyThePolarityAskedFor) {
  SyntheticScene scene(300, 200, 125);
  PaintEllipse({{80, 100}, 16, 16, 0}, 220, &scene);
  PaintEllipse({{200, 100}, 16, 16, 0}, 30, &scene);
  DotOptions options;

  EXPECT_EQ(DetectIn(scene, options).size(), 2u);
  options.polarity = DotPolarity::kBright;
  ASSERT_EQ(DetectIn(scene, options).size(), 1u);
  EXPECT_NEAR(DetectIn(scene, options)[0].centroid.x(), 80, 0.1);  // px
  options.polarity = DotPolarity::kDark;
  ASSERT_EQ(DetectIn(scene, options).size(), 1u);
  EXPECT_NEAR(DetectIn(scene, options)[0].centroid.x(), 200, 0.1);  // px
}

TEST(DetectDots, FindsNoDotInNoise) {
  std::mt19937 random(11);
  EXPECT_TRUE(DetectDots(SyntheticScene(640, 512, 128).TakePicture(10, random)).empty());
}

TEST(DotOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](auto change) {
    DotOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(DotOptions().Check());
  refuses([](DotOptions& o) { o.min_diameter = 2; });
  refuses([](DotOptions& o) { o.min_diameter = NAN; });
  refuses([](DotOptions& o) { o.max_diameter = 3; });
  refuses([](DotOptions& o) { o.max_diameter = INFINITY; });
  refuses([](DotOptions& o) { o.min_axis_ratio = 0; });
  refuses([](DotOptions& o) { o.min_axis_ratio = 1.1; });
  refuses([](DotOptions& o) { o.min_contrast = 0; });
  refuses([](DotOptions& o) { o.min_contrast = 256; });
  refuses([](DotOptions& o) { o.max_ellipse_misfit = 0; });
}

}  // namespace
}  // namespace softforce::vision
