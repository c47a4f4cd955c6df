#include "render/colour_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "render/palette.h"

namespace softforce::render {
ColourScale::ColourScale() {
  cv::Mat1b shares(1, kColours);
  for (int i = 0; i < kColours; ++i) shares(0, i) = static_cast<uchar>(i);
  cv::Mat3b colours;
  cv::applyColorMap(shares, colours, cv::COLORMAP_VIRIDIS);
  std::copy(colours.begin(), colours.end(), colours_.begin());
}

cv::Vec3b ColourScale::At(double share) const {
  return Number(static_cast<float>(share * (kColours - 1)));
}

namespace {

int Padding(const TextStyle& style) { return cvRound(20 * style.scale); }

}  // namespace

int ColourBarWidth(const SurfaceField& field, const TextStyle& style) {
  return MeasureText(field.name, style).width + 2 * Padding(style);
}

cv::Rect DrawColourBar(Brush* brush, cv::Mat3b picture, const SurfaceField& field,
                       const cv::Point& corner, const TextStyle& style) {
  const double unit = 2 * style.scale;
  const TextExtent extent = MeasureText(field.name, style);
  const int line = extent.above + extent.below;
  const int pad = Padding(style);
  const cv::Size bar(cvRound(14 * unit), std::min(cvRound(180 * unit), picture.rows / 5));
  const cv::Size plate(ColourBarWidth(field, style), bar.height + 2 * line + 3 * pad);
  const cv::Rect box(cv::Point(corner.x - plate.width, corner.y), plate);
  DrawPlate(brush, box);
  DrawText(brush, field.name, {box.x + pad, box.y + pad + extent.above}, style, kWhite);

  const ColourScale colours;
  const cv::Point top(box.x + pad, box.y + 2 * pad + line + line / 2);
  for (int y = 0; y < bar.height; ++y) {
    const double share = 1 - (y + 0.5) / bar.height;
    const cv::Rect row = cv::Rect(top.x, top.y + y, bar.width, 1) & cv::Rect({}, picture.size());
    if (!row.empty()) picture(row).setTo(cv::Scalar(colours.At(share)));
  }
  for (const double share : {0.0, 0.5, 1.0}) {
    const int y = top.y + static_cast<int>(std::lround((1 - share) * bar.height));
    const std::string number =
        fmt::format("{:.3g}{}", share * field.largest, share == 1 ? " " + field.unit : "");
    brush->Line(cv::Point2d(top.x + bar.width, y), cv::Point2d(top.x + bar.width + 5 * unit, y), 1);
    brush->Paint(kWhite, 1);
    DrawText(brush, number, {top.x + bar.width + pad, y + MeasureText(number, style).above / 2},
             style, kWhite);
  }
  return box;
}

}  // namespace softforce::render
