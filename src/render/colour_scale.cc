#include "render/colour_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "render/palette.h"

namespace softforce::render {
namespace {

constexpr int kColours = 256;

}  // namespace

ColourScale::ColourScale() {
  cv::Mat1b shares(1, kColours);
  for (int i = 0; i < kColours; ++i) shares(0, i) = static_cast<uchar>(i);
  cv::Mat colours;
  cv::applyColorMap(shares, colours, cv::COLORMAP_VIRIDIS);
  colours_ = colours;
}

cv::Vec3b ColourScale::At(double share) const {
  // In this order NaN ends up at the lower end.
  const double clamped = std::min(std::max(0.0, share), 1.0);
  return colours_(0, static_cast<int>(std::lround(clamped * (kColours - 1))));
}

cv::Rect DrawColourBar(Brush* brush, cv::Mat3b picture, const SurfaceField& field,
                       const cv::Point& corner, const TextStyle& style, double unit) {
  const std::string title = fmt::format("{}, {}", field.name, field.unit);
  const TextExtent extent = MeasureText(title, style);
  const int line = extent.above + extent.below;
  const int pad = static_cast<int>(10 * unit);
  const cv::Size bar(static_cast<int>(18 * unit), static_cast<int>(180 * unit));
  const cv::Size plate(extent.width + 2 * pad, bar.height + 2 * line + 3 * pad);
  const cv::Rect box(cv::Point(corner.x - plate.width, corner.y), plate);
  DrawPlate(brush, box);
  DrawText(brush, title, {box.x + pad, box.y + pad + extent.above}, style, kWhite);

  const ColourScale colours;
  const cv::Point top(box.x + pad, box.y + 2 * pad + line + line / 2);
  for (int y = 0; y < bar.height; ++y) {
    const double share = 1 - (y + 0.5) / bar.height;
    const cv::Rect row = cv::Rect(top.x, top.y + y, bar.width, 1) & cv::Rect({}, picture.size());
    if (!row.empty()) picture(row).setTo(cv::Scalar(colours.At(share)));
  }
  for (const double share : {0.0, 0.5, 1.0}) {
    const int y = top.y + static_cast<int>(std::lround((1 - share) * bar.height));
    const std::string number = fmt::format("{:.3g}", share * field.largest);
    brush->Line(cv::Point2d(top.x + bar.width, y), cv::Point2d(top.x + bar.width + 5 * unit, y), 1);
    brush->Paint(kWhite, 1);
    DrawText(brush, number, {top.x + bar.width + pad, y + MeasureText(number, style).above / 2},
             style, kWhite);
  }
  return box;
}

}  // namespace softforce::render
