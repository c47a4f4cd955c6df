#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <iostream>
#include <random>

#include "softforce/vision/dots.h"
#include "vision/synthetic_picture.h"

namespace softforce::vision {
namespace {

using softforce::testing::PaintDisc;
using softforce::testing::PaintEllipse;
using softforce::testing::SyntheticScene;

constexpr double kBlur = 0.7;   // px
constexpr double kNoise = 2;    // grey levels
constexpr double kGround = 60;  // grey levels
constexpr double kPaint = 190;  // grey levels
const camera::Lens kLens{1603.2, 1601.7, 119.3, 120.6, {-0.12, 0.08, 0.0006, -0.0004}};

struct Case {
  double diameter_px;
  bool bright;
  int dots;
  double blur = kBlur;    // px
  double max_slant = 50;  // degrees
  double max_rms = 0.03;  // px; noise of 2 grey levels on a contrast of 130 leaves 0.012
};

// A disc anywhere near the middle of the picture, slanted in any direction.
struct Disc {
  Eigen::Vector3d centre, normal;  // camera frame; m
  double diameter;                 // m
};
Disc RandomDisc(const Case& look, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double distance = 0.5;  // m
  Disc disc;
  disc.centre = distance * Eigen::Vector3d(0.005 * unit(random), 0.005 * unit(random), 1);
  disc.diameter = look.diameter_px * distance / kLens.fx;
  const Eigen::Vector3d axis = Eigen::Vector3d(unit(random), unit(random), 0).normalized();
  const double slant = look.max_slant * M_PI / 180 * std::abs(unit(random));
  disc.normal = Eigen::AngleAxisd(slant, axis) * -Eigen::Vector3d::UnitZ();
  return disc;
}

// How the centroids of many dots scatter about camera::ProjectDiscCentroid.
struct Scatter {
  int found = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  // px
  double rms = 0;                                  // px, per axis
  double normalised = 0;                           // mean of squared error over covariance, halved
};
Scatter MeasureScatter(const Case& look) {
  const bool bright = look.bright;
  const int count = look.dots;
  std::mt19937 random(17);
  Scatter scatter;
  for (int i = 0; i < count; ++i) {
    const Disc disc = RandomDisc(look, random);
    SyntheticScene scene(240, 240, bright ? kGround : kPaint, look.blur);
    PaintDisc(kLens, disc.centre, disc.normal, disc.diameter, bright ? kPaint : kGround, &scene);
    scene.Shade({5e-4, -3e-4});  // light that changes by 12 % over the picture
    const auto dots = DetectDots(scene.TakePicture(kNoise, random));
    const auto truth = camera::ProjectDiscCentroid(kLens, disc.centre, disc.normal, disc.diameter);
    if (dots.size() != 1 || (dots[0].contrast > 0) != bright) continue;
    const Eigen::Vector2d error = dots[0].centroid - *truth;
    ++scatter.found;
    scatter.mean += error / count;
    scatter.rms += error.squaredNorm() / 2 / count;
    scatter.normalised += error.dot(dots[0].covariance.inverse() * error) / 2 / count;
  }
  scatter.rms = std::sqrt(scatter.rms);
  std::cout << "dots of " << look.diameter_px << " px, blur " << look.blur << " px, "
            << (bright ? "bright" : "dark") << ": RMS per axis " << scatter.rms << " px, bias "
            << scatter.mean.transpose() << " px, normalised " << scatter.normalised << "\n";
  ::testing::Test::RecordProperty("rms_px", std::to_string(scatter.rms));
  ::testing::Test::RecordProperty("normalised", std::to_string(scatter.normalised));
  return scatter;
}

class DotAccuracy : public ::testing::TestWithParam<Case> {};

TEST_P(DotAccuracy, CentroidIsThatOfTheProjectedDisc) {
  const Case& look = GetParam();

  const Scatter scatter = MeasureScatter(look);

  EXPECT_EQ(scatter.found, look.dots);
  EXPECT_LT(scatter.rms, look.max_rms);
  // px; four standard errors of the mean
  EXPECT_LT(scatter.mean.cwiseAbs().maxCoeff(),
            std::max(0.005, 4 * look.max_rms / std::sqrt(look.dots)));
  // The covariance is honest, up to three standard errors where the dots are few.
  const double slack = look.dots >= 300 ? 0 : 3 / std::sqrt(look.dots);
  EXPECT_GT(scatter.normalised, 0.8 - slack);
  EXPECT_LT(scatter.normalised, 1.25 + slack);
}

INSTANTIATE_TEST_SUITE_P(Sizes, DotAccuracy,
                         ::testing::Values(Case{5.5, true, 60, kBlur, 15, 0.04}, Case{8, true, 320},
                                           Case{8, false, 320}, Case{15, true, 320},
                                           Case{15, false, 320}, Case{30, true, 40},
                                           Case{50, false, 16}, Case{60, true, 12}));

// Blur draws the edge out: its pixels, and so the noise, are some times as many.
INSTANTIATE_TEST_SUITE_P(OutOfFocus, DotAccuracy,
                         ::testing::Values(Case{15, true, 40, 1.5, 40, 0.04},
                                           Case{20, false, 30, 2.5, 40, 0.06}));

TEST(DetectDots, FindsTheSameCentroidWhereverTheDotLiesInItsPixel) {
  std::mt19937 random(3);
  for (double shift = 0; shift < 1; shift += 0.125) {
    const Eigen::Vector2d centre(60 + shift, 55 - 0.5 * shift);
    SyntheticScene scene(120, 110, kGround, kBlur);
    PaintEllipse({centre, 15, 12, 0.4}, kPaint, &scene);

    const auto dots = DetectDots(scene.TakePicture(0, random));

    ASSERT_EQ(dots.size(), 1u) << shift;
    // px; the paint itself has 128 samples in a pixel, and grey levels are whole
    EXPECT_LT((dots[0].centroid - centre).norm(), 0.02) << shift;
  }
}

TEST(DetectDots, ReportsAxesAndContrast) {
  std::mt19937 random(3);
  SyntheticScene scene(120, 110, kPaint, kBlur);
  PaintEllipse({{60.3, 55.1}, 24, 15, 0.7}, kGround, &scene);

  const auto dots = DetectDots(scene.TakePicture(kNoise, random));

  ASSERT_EQ(dots.size(), 1u);
  EXPECT_NEAR(dots[0].long_axis, 24, 0.5);             // px; from pixels counted whole
  EXPECT_NEAR(dots[0].short_axis, 15, 0.5);            // px
  EXPECT_NEAR(dots[0].contrast, kGround - kPaint, 2);  // grey levels
}

TEST(DetectDots, OrdersByRowAndGivesTheSameListTwice) {
  std::mt19937 random(3);
  SyntheticScene scene(300, 200, kGround, kBlur);
  for (const Eigen::Vector2d& centre :
       {Eigen::Vector2d(240, 60), Eigen::Vector2d(50, 150), Eigen::Vector2d(140, 30)}) {
    PaintEllipse({centre, 14, 12, 0}, kPaint, &scene);
  }
  const cv::Mat picture = scene.TakePicture(kNoise, random);

  const auto first = DetectDots(picture);
  const auto second = DetectDots(picture);

  ASSERT_EQ(first.size(), 3u);
  ASSERT_EQ(second.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(first[i].centroid, second[i].centroid);
  EXPECT_LT(first[0].centroid.y(), first[1].centroid.y());
  EXPECT_LT(first[1].centroid.y(), first[2].centroid.y());
}

}  // namespace
}  // namespace softforce::vision
