#pragma once

#include <string>
#include <vector>

#include "render/brush.h"
#include "render/text.h"

namespace softforce::render {

// Words beside a point of the picture.
struct Label {
  std::string text;
  TextStyle style;
  cv::Vec3b colour;
  bool plate = false;     // a dark ground under the words
  cv::Point2d anchor;     // px
  double clearance = 0;   // px, between the anchor and the words
  cv::Point2d preferred;  // unit vector from the anchor to where they should rather stand, or 0
};

// Chooses a place for each label, the first ones first, away from `occupied` boxes and from each
// other as far as the picture allows. Returns the box of each label.
std::vector<cv::Rect> PlaceLabels(const std::vector<Label>& labels,
                                  const std::vector<cv::Rect>& occupied, const cv::Size& picture);

void DrawLabel(Brush* brush, const Label& label, const cv::Rect& box);

// Lines of text on a plate, with the top-left corner of the plate at `corner`.
void DrawTextBlock(Brush* brush, const std::vector<std::string>& lines, const cv::Point& corner,
                   const TextStyle& style);

// The style, or a smaller one in which the plate is no wider than this (px).
TextStyle Fitted(const std::vector<std::string>& lines, TextStyle style, int width);

// The box that DrawTextBlock fills.
cv::Rect TextBlockBox(const std::vector<std::string>& lines, const cv::Point& corner,
                      const TextStyle& style);

}  // namespace softforce::render
