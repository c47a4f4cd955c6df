#include "softforce/render/force_chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace softforce::render {
namespace {

constexpr int kWidth = 800, kHeight = 150;
const cv::Scalar kFirstColour(0, 159, 230);  // blue green red

cv::Mat1b PixelsOf(const cv::Mat& chart, const cv::Scalar& colour) {
  cv::Mat1b pixels;
  cv::inRange(chart, colour, colour, pixels);
  return pixels;
}

ChartSeries Constant(double force, double sd) {
  ChartSeries series{"F0", {}, {}, {}};
  for (int i = 0; i <= 100; ++i) {
    series.time_s.push_back(0.1 * i);
    series.value.push_back(force);
    series.sd.push_back(sd);
  }
  return series;
}

cv::Mat Chart(const std::vector<ChartSeries>& series, double now_s, double span_s) {
  cv::Mat3b strip(kHeight, kWidth);
  DrawForceChart(strip, series, now_s, span_s);
  return std::move(strip);
}

// Rows of the line itself, left of the words.
cv::Rect LineOf(const cv::Mat& chart) {
  return cv::boundingRect(PixelsOf(chart, kFirstColour).colRange(0, kWidth - 200));
}

TEST(ForceChart, RoundsItsScaleUp) {
  EXPECT_DOUBLE_EQ(RoundUp(1), 1);
  EXPECT_DOUBLE_EQ(RoundUp(0.0203), 0.03);
  EXPECT_DOUBLE_EQ(RoundUp(8.1), 10);
  EXPECT_DOUBLE_EQ(RoundUp(250), 300);
}

TEST(ForceChart, AConstantForceIsALevelLineAtItsHeight) {
  const cv::Rect half = LineOf(Chart({Constant(0.5, 0)}, 10, 10));
  const cv::Rect full = LineOf(Chart({Constant(1, 0)}, 10, 10));
  EXPECT_LE(half.height, 5) << "px, a line of 2 that ends in a disc of 5";
  EXPECT_GT(half.width, kWidth / 2);
  EXPECT_EQ(half.y, full.y) << "each fills its own scale, 0.5 N and 1 N";
  const ChartSeries two[] = {Constant(0.5, 0), Constant(1, 0)};
  const cv::Rect lower = LineOf(Chart({two[0], two[1]}, 10, 10));
  EXPECT_GT(lower.y, full.y + 20) << "px; beside 1 N, 0.5 N is half as high";
}

TEST(ForceChart, TheBandIsAsWideAsTheStandardDeviation) {
  const cv::Mat thin = Chart({Constant(0.5, 0.01)}, 10, 10);
  const cv::Mat wide = Chart({Constant(0.5, 0.1)}, 10, 10);
  const cv::Mat none = Chart({Constant(0.5, 0)}, 10, 10);
  const auto height = [&](const cv::Mat& chart) {
    const cv::Vec3b ground = chart.at<cv::Vec3b>(2, 2);
    int rows = 0;
    for (int y = 0; y < kHeight - 30; ++y) {
      const cv::Vec3b pixel = chart.at<cv::Vec3b>(y, kWidth / 2);
      rows += pixel != ground && pixel[2] > pixel[0] + 20;  // orange, or its shade
    }
    return rows;
  };
  EXPECT_GT(height(wide), 4 * height(thin));
  EXPECT_GT(height(thin), height(none));
}

TEST(ForceChart, AGapStaysAGap) {
  ChartSeries series = Constant(0.5, 0.01);
  for (int i = 40; i < 60; ++i) series.value[i] = series.sd[i] = NAN;
  const cv::Mat1b line = PixelsOf(Chart({series}, 10, 10), kFirstColour);
  const cv::Rect whole = LineOf(Chart({Constant(0.5, 0)}, 10, 10));
  const int middle = whole.x + whole.width / 2;
  EXPECT_EQ(cv::countNonZero(line.colRange(middle - 20, middle + 20)), 0);
  EXPECT_GT(cv::countNonZero(line.colRange(whole.x, middle - 80)), 0);
}

TEST(ForceChart, WithoutForcesItIsAnEmptyScale) {
  const cv::Mat chart = Chart({}, 1, 1);
  EXPECT_EQ(chart.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(cv::countNonZero(PixelsOf(chart, kFirstColour)), 0);
}

}  // namespace
}  // namespace softforce::render
