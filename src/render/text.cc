#include "render/text.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "render/palette.h"

namespace softforce::render {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
const std::string kPlusMinus = "±";

// The text cut at each ±, which stands as a piece of its own.
std::vector<std::string> Pieces(const std::string& text) {
  std::vector<std::string> pieces;
  size_t start = 0;
  while (start < text.size()) {
    const size_t sign = text.find(kPlusMinus, start);
    if (sign == start) {
      pieces.push_back(kPlusMinus);
      start += kPlusMinus.size();
    } else {
      pieces.push_back(text.substr(start, sign - start));
      start = sign == std::string::npos ? text.size() : sign;
    }
  }
  return pieces;
}

cv::Size PieceSize(const std::string& piece, const TextStyle& style, int* below) {
  return cv::getTextSize(piece == kPlusMinus ? "+" : piece, kFont, style.scale, style.width, below);
}

void DrawPlusMinus(Brush* brush, const cv::Point2d& baseline_left, const cv::Size& size,
                   int width) {
  const double arm = 0.28 * size.width;
  const cv::Point2d foot = baseline_left + cv::Point2d(0.5 * size.width, 0);
  const cv::Point2d cross = foot - cv::Point2d(0, size.height - arm);
  brush->Line(cross - cv::Point2d(arm, 0), cross + cv::Point2d(arm, 0), width);
  brush->Line(cross - cv::Point2d(0, arm), cross + cv::Point2d(0, arm), width);
  brush->Line(foot - cv::Point2d(arm, 0), foot + cv::Point2d(arm, 0), width);
}

void Letters(Brush* brush, const std::string& text, cv::Point at, const TextStyle& style,
             int width) {
  for (const std::string& piece : Pieces(text)) {
    int below = 0;
    const cv::Size size = PieceSize(piece, style, &below);
    if (piece == kPlusMinus) {
      DrawPlusMinus(brush, at, size, width);
    } else {
      brush->Text(piece, at, kFont, style.scale, width);
    }
    at.x += size.width;
  }
}

}  // namespace

TextExtent MeasureText(const std::string& text, const TextStyle& style) {
  TextExtent extent;
  for (const std::string& piece : Pieces(text)) {
    int below = 0;
    const cv::Size size = PieceSize(piece, style, &below);
    extent.width += size.width;
    extent.above = std::max(extent.above, size.height);
    extent.below = std::max(extent.below, below);
  }
  return extent;
}

void DrawText(Brush* brush, const std::string& text, const cv::Point& baseline_left,
              const TextStyle& style, const cv::Vec3b& colour) {
  Letters(brush, text, baseline_left, style, style.width + 2);
  brush->Paint(kBlack, 0.7);
  Letters(brush, text, baseline_left, style, style.width);
  brush->Paint(colour, 1);
}

void DrawPlate(Brush* brush, const cv::Rect& box) {
  const double radius = 0.2 * std::min(box.width, box.height);
  const cv::Point2d inner_a(box.x + radius, box.y + radius);
  const cv::Point2d inner_b(box.br().x - radius, box.br().y - radius);
  std::vector<cv::Point2d> outline;
  for (int angle = 0; angle < 360; angle += 15) {
    const double a = (angle + 7.5) * CV_PI / 180;
    const cv::Point2d centre(std::cos(a) > 0 ? inner_b.x : inner_a.x,
                             std::sin(a) > 0 ? inner_b.y : inner_a.y);
    outline.push_back(centre + radius * cv::Point2d(std::cos(a), std::sin(a)));
  }
  brush->Polygon(outline);
  brush->Paint(kBlack, 0.55);
}

}  // namespace softforce::render
