#include "softforce/vision/tag_cells.h"

#include <fmt/format.h>

#include <memory>

#include "softforce/base/input_error.h"
#include "vision/tag_family.h"

namespace softforce::vision {

TagCells DrawTag(const std::string& family, int id, const std::string& where, int black_border) {
  const FamilyMaker& maker = MakerOf(family, where);
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> made(
      CreateFamily(maker, black_border), maker.destroy);
  if (id < 0 || id >= static_cast<int>(made->ncodes)) {
    throw base::InputError(
        where, fmt::format("{} has no tag {}, its ids are 0 to {}", family, id, made->ncodes - 1));
  }
  image_u8_t* image = apriltag_to_image(made.get(), static_cast<uint32_t>(id));
  TagCells tag;
  tag.cells = cv::Mat1b(image->height, image->width, image->buf, image->stride).clone();
  tag.margin = (made->total_width - made->width_at_border) / 2;
  image_u8_destroy(image);
  if (maker.turned_by_opencv) cv::flip(tag.cells, tag.cells, -1);  // by half a turn
  return tag;
}

}  // namespace softforce::vision
