#pragma once

#include <optional>
#include <vector>

#include "render/view.h"
#include "softforce/render/picture.h"

namespace softforce::render {

// How large the picture of a sticker on the body would be if nothing stood before it.
class StickerArea {
 public:
  StickerArea(const Sticker& sticker, const PictureWorld& world);

  // px²; 0 if it faces away or is not in the lens's field.
  double At(const View& view, const Eigen::Matrix3Xd& x) const;

 private:
  std::vector<mesh::NodalWeights> rim_;  // of the disc, or of the square
  double of_polygon_;                    // area over that of the polygon
};

}  // namespace softforce::render
