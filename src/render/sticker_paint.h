#pragma once

#include <Eigen/Core>
#include <optional>

#include "softforce/render/picture.h"

namespace softforce::render {

struct StickerPaint {
  bool white = true;
  bool within = true;  // the disc, or the square of the tag without its margin
};

// What a sticker shows at a place of the surface at rest; nothing beyond its rim.
inline std::optional<StickerPaint> PaintAt(const Sticker& sticker, const Eigen::Vector3d& X) {
  const Eigen::Vector3d from_centre = X - sticker.centre;
  const double s = from_centre.dot(sticker.right) / sticker.size;
  const double t = from_centre.dot(sticker.up) / sticker.size;
  if (sticker.cells.empty()) {
    if (s * s + t * t > 0.25) return std::nullopt;
    return StickerPaint{};
  }
  const double inner = sticker.cells.cols - 2 * sticker.margin;
  const int x = static_cast<int>(std::floor((s + 0.5) * inner)) + sticker.margin;
  const int y = static_cast<int>(std::floor((0.5 - t) * inner)) + sticker.margin;
  if (x < 0 || y < 0 || x >= sticker.cells.cols || y >= sticker.cells.rows) return std::nullopt;
  return StickerPaint{sticker.cells(y, x) > 0, std::abs(s) <= 0.5 && std::abs(t) <= 0.5};
}

}  // namespace softforce::render
