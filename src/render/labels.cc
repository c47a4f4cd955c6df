#include "render/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/palette.h"

namespace softforce::render {
namespace {

int Padding(const TextStyle& style, bool plate) {
  return static_cast<int>(std::lround((plate ? 10 : 2) * style.scale));
}

int LineHeight(const TextStyle& style) {
  const TextExtent extent = MeasureText("Ag", style);
  return static_cast<int>(std::lround(1.25 * (extent.above + extent.below)));
}

// The box of `size` that touches the circle of `clearance` around the anchor in a direction.
cv::Rect BoxBeside(const Label& label, const cv::Size& size, const cv::Point2d& direction,
                   double clearance) {
  const cv::Point2d centre =
      label.anchor + cv::Point2d(direction.x * (clearance + size.width / 2.0),
                                 direction.y * (clearance + size.height / 2.0));
  return {cv::Point(static_cast<int>(std::lround(centre.x - size.width / 2.0)),
                    static_cast<int>(std::lround(centre.y - size.height / 2.0))),
          size};
}

// px², more where words cover words.
double Cost(const cv::Rect& box, const std::vector<cv::Rect>& occupied,
            const std::vector<cv::Rect>& words, const cv::Rect& picture) {
  double covered = 0;
  for (const cv::Rect& other : occupied) covered += (box & other).area();
  for (const cv::Rect& other : words) covered += 4.0 * (box & other).area();
  return covered + 10.0 * (box.area() - (box & picture).area());
}

}  // namespace

std::vector<cv::Rect> PlaceLabels(const std::vector<Label>& labels,
                                  const std::vector<cv::Rect>& occupied, const cv::Size& picture) {
  // The customary directions for a map's lettering first, then those between them.
  static const std::array<cv::Point2d, 16> kDirections{{{0.8, -0.8},
                                                        {1, 0},
                                                        {0.8, 0.8},
                                                        {-0.8, -0.8},
                                                        {-1, 0},
                                                        {-0.8, 0.8},
                                                        {0, -1},
                                                        {0, 1},
                                                        {1, -0.5},
                                                        {1, 0.5},
                                                        {-1, -0.5},
                                                        {-1, 0.5},
                                                        {0.4, -1},
                                                        {0.4, 1},
                                                        {-0.4, -1},
                                                        {-0.4, 1}}};
  const cv::Rect whole(cv::Point(), picture);
  std::vector<cv::Rect> boxes;
  for (const Label& label : labels) {
    const TextExtent extent = MeasureText(label.text, label.style);
    const int padding = Padding(label.style, label.plate);
    const cv::Size size(extent.width + 2 * padding, extent.above + extent.below + 2 * padding);
    cv::Rect best;
    double lowest = std::numeric_limits<double>::infinity();
    for (const double reach : {1.0, 2.0, 3.5, 5.5}) {
      for (size_t i = 0; i < kDirections.size(); ++i) {
        const cv::Rect box = BoxBeside(label, size, kDirections[i], reach * label.clearance);
        // Preferences weigh like a little coverage, so that they only decide between free places.
        const double turned = 1 - kDirections[i].dot(label.preferred) / cv::norm(kDirections[i]);
        const double cost = Cost(box, occupied, boxes, whole) + 8 * (reach - 1) + 4 * turned +
                            0.1 * static_cast<double>(i);
        if (cost >= lowest) continue;
        lowest = cost;
        best = box;
      }
    }
    boxes.push_back(best);
  }
  return boxes;
}

void DrawLabel(Brush* brush, const Label& label, const cv::Rect& box) {
  const int padding = Padding(label.style, label.plate);
  if (label.plate) DrawPlate(brush, box);
  const int baseline = box.y + padding + MeasureText(label.text, label.style).above;
  DrawText(brush, label.text, {box.x + padding, baseline}, label.style, label.colour);
}

cv::Rect TextBlockBox(const std::vector<std::string>& lines, const cv::Point& corner,
                      const TextStyle& style) {
  int width = 0;
  for (const std::string& line : lines) width = std::max(width, MeasureText(line, style).width);
  const int padding = Padding(style, true);
  const TextExtent letters = MeasureText("Ag", style);
  const int height =
      LineHeight(style) * (static_cast<int>(lines.size()) - 1) + letters.above + letters.below;
  return {corner, cv::Size(width + 2 * padding, height + 2 * padding)};
}

TextStyle Fitted(const std::vector<std::string>& lines, TextStyle style, int width) {
  const int wanted = TextBlockBox(lines, {}, style).width;
  if (wanted > width) style.scale *= std::max(1, width) / static_cast<double>(wanted);
  return style;
}

void DrawTextBlock(Brush* brush, const std::vector<std::string>& lines, const cv::Point& corner,
                   const TextStyle& style) {
  if (lines.empty()) return;
  DrawPlate(brush, TextBlockBox(lines, corner, style));
  const int padding = Padding(style, true);
  cv::Point at = corner + cv::Point(padding, padding);
  for (const std::string& line : lines) {
    DrawText(brush, line, at + cv::Point(0, MeasureText("Ag", style).above), style, kWhite);
    at.y += LineHeight(style);
  }
}

}  // namespace softforce::render
