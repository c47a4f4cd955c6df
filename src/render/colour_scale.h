#pragma once

#include <opencv2/core.hpp>

#include "render/brush.h"
#include "render/text.h"
#include "softforce/render/overlay.h"

namespace softforce::render {

// Colours whose lightness grows evenly, for every kind of colour vision (viridis).
class ColourScale {
 public:
  ColourScale();

  cv::Vec3b At(double share) const;  // 0 to 1; beyond it the colour of the end

 private:
  cv::Mat3b colours_;
};

// Name, colours and numbers of a field, on a plate whose top-right corner is `corner`. Returns the
// plate's box.
cv::Rect DrawColourBar(Brush* brush, cv::Mat3b picture, const SurfaceField& field,
                       const cv::Point& corner, const TextStyle& style, double unit);

}  // namespace softforce::render
