#pragma once

#include <string>

#include "render/brush.h"

namespace softforce::render {

// OpenCV's letters, and the sign ± that they lack.
struct TextStyle {
  double scale = 0.55;  // of the font, for a picture of unit 1
  double width = 1;     // px, of the letters' strokes
};

struct TextExtent {
  int width = 0, above = 0, below = 0;  // px, from the left end of the baseline
};

TextExtent MeasureText(const std::string& text, const TextStyle& style);

// The letters in `colour`, with a dark seam around them to be read on any picture.
void DrawText(Brush* brush, const std::string& text, const cv::Point& baseline_left,
              const TextStyle& style, const cv::Vec3b& colour);

// A dark translucent ground for text.
void DrawPlate(Brush* brush, const cv::Rect& box);

}  // namespace softforce::render
