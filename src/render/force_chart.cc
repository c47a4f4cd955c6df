#include "softforce/render/force_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "render/brush.h"
#include "render/palette.h"
#include "render/region.h"
#include "render/text.h"

namespace softforce::render {
namespace {

constexpr double kFullHeight = 150;  // px, of a strip in which letters have size 1
constexpr double kLeastText = 0.9;
const cv::Vec3b kGround(32, 32, 32), kGrid(80, 80, 80), kWords(200, 200, 200);
const std::array<cv::Vec3b, 6> kColours{kOrange, kSkyBlue, kGreen, kYellow, kPurple, kVermillion};

// From seconds and newtons to the chart's pixels.
struct Axes {
  cv::Rect box;  // of the lines
  double from_s, to_s, top;

  cv::Point2d At(double time_s, double force) const {
    return {box.x + (time_s - from_s) / (to_s - from_s) * box.width,
            box.br().y - std::min(std::max(force / top, 0.0), 1.0) * box.height};
  }
};

double LargestShown(const std::vector<ChartSeries>& series, double from_s) {
  double largest = 0;
  for (const ChartSeries& one : series) {
    for (size_t i = 0; i < one.value.size(); ++i) {
      const double upper = one.value[i] + kHalfWidth * one.sd[i];
      if (one.time_s[i] >= from_s && upper > largest) largest = upper;
    }
  }
  return largest;
}

void DrawGrid(Brush* brush, const Axes& axes, const TextStyle& style) {
  for (const double share : {0.0, 0.5, 1.0}) {
    const cv::Point2d left = axes.At(axes.from_s, share * axes.top);
    brush->Line(left, axes.At(axes.to_s, share * axes.top), 1);
    brush->Paint(kGrid, 1);
    const std::string number = fmt::format("{:.3g}{}", share * axes.top, share == 1 ? " N" : "");
    const TextExtent extent = MeasureText(number, style);
    DrawText(
        brush, number,
        {static_cast<int>(left.x) - extent.width - 8, static_cast<int>(left.y) + extent.above / 2},
        style, kWords);
  }
  // At round times, some five of them, and 0 without a sign.
  const double step = RoundUp((axes.to_s - axes.from_s) / 6);
  for (double t = std::ceil(axes.from_s / step) * step + 0.0; t <= axes.to_s; t += step) {
    const cv::Point2d foot = axes.At(t, 0);
    brush->Line(foot, foot - cv::Point2d(0, 4), 1);
    brush->Paint(kWords, 1);
    const std::string number = fmt::format("{:.4g} s", t);
    const TextExtent extent = MeasureText(number, style);
    DrawText(
        brush, number,
        {static_cast<int>(foot.x) - extent.width / 2, static_cast<int>(foot.y) + extent.above + 6},
        style, kWords);
  }
}

void DrawSeries(Brush* brush, const Axes& axes, const ChartSeries& one, const cv::Vec3b& colour) {
  const size_t n = one.time_s.size();
  const auto known = [&](size_t i) {
    return one.time_s[i] >= axes.from_s && std::isfinite(one.value[i]);
  };
  for (size_t i = 0; i + 1 < n; ++i) {
    if (!known(i) || !known(i + 1) || !std::isfinite(one.sd[i] + one.sd[i + 1])) continue;
    const auto edge = [&](size_t k, double side) {
      return axes.At(one.time_s[k], one.value[k] + side * kHalfWidth * one.sd[k]);
    };
    brush->Polygon({edge(i, 1), edge(i + 1, 1), edge(i + 1, -1), edge(i, -1)});
  }
  brush->Paint(colour, 0.35);
  for (size_t i = 0; i < n; ++i) {
    if (!known(i)) continue;
    const cv::Point2d at = axes.At(one.time_s[i], one.value[i]);
    if (i + 1 < n && known(i + 1)) {
      brush->Line(at, axes.At(one.time_s[i + 1], one.value[i + 1]), 2);
    } else {
      brush->Disc(at, 2.5);
    }
  }
  brush->Paint(colour, 1);
}

}  // namespace

double RoundUp(double number) {
  const double power = std::pow(10, std::floor(std::log10(number)));
  for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (digit * power >= number * (1 - 1e-12)) return digit * power;
  }
  return 10 * power;
}

void DrawForceChart(cv::Mat3b strip, const std::vector<ChartSeries>& series, double now_s,
                    double span_s, Easel* easel) {
  assert(span_s > 0);
  strip.setTo(cv::Scalar(kGround));
  Easel own;
  Brush brush(strip, easel != nullptr ? easel : &own);
  const cv::Size size = strip.size();
  const double unit = std::max(kLeastText, size.height / kFullHeight);
  const TextStyle style{0.45 * unit, std::max(1.0, unit)};
  const int line = MeasureText("0", style).above;
  const int left = MeasureText("0.005 N", style).width + 16, right = cvRound(200 * unit);
  Axes axes{
      {left, 2 * line, std::max(1, size.width - left - right), std::max(1, size.height - 5 * line)},
      now_s - span_s,
      now_s,
      1};
  axes.from_s -= 1e-9 * span_s;  // rounding must not cost the first point
  const double largest = LargestShown(series, axes.from_s);
  if (largest > 0) axes.top = RoundUp(largest);
  DrawGrid(&brush, axes, style);
  int baseline = axes.box.y + line;
  for (size_t s = 0; s < series.size(); ++s) {
    const ChartSeries& one = series[s];
    const cv::Vec3b& colour = kColours[s % kColours.size()];
    DrawSeries(&brush, axes, one, colour);
    if (baseline > size.height - line || one.value.empty()) continue;
    std::string text = one.label;
    if (std::isfinite(one.value.back())) text += fmt::format("  {:.3f} N", one.value.back());
    DrawText(&brush, text, {axes.box.br().x + 16, baseline}, style, colour);
    baseline += 2 * line;
  }
}

}  // namespace softforce::render
