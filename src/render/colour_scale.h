#pragma once

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "render/brush.h"
#include "render/text.h"
#include "softforce/render/overlay.h"

namespace softforce::render {

// Colours whose lightness grows evenly, for every kind of colour vision (viridis).
class ColourScale {
 public:
  ColourScale();

  static constexpr int kColours = 256;

  cv::Vec3b At(double share) const;  // 0 to 1; beyond it the colour of the end

  // The same by the number of the colour, 0 to kColours - 1.
  const cv::Vec3b& Number(float number) const {
    // In this order NaN ends up at the lower end.
    const float rounded = std::min(std::max(0.5f, number + 0.5f), kColours - 0.5f);
    return colours_[static_cast<size_t>(rounded)];
  }

 private:
  std::array<cv::Vec3b, kColours> colours_;
};

// px, of the plate that DrawColourBar fills.
int ColourBarWidth(const SurfaceField& field, const TextStyle& style);

// Name, colours and numbers of a field, on a plate whose top-right corner is `corner`. Returns the
// plate's box.
cv::Rect DrawColourBar(Brush* brush, cv::Mat3b picture, const SurfaceField& field,
                       const cv::Point& corner, const TextStyle& style);

}  // namespace softforce::render
