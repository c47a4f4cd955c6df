#include "vision/tag_family.h"

#include <fmt/format.h>
#include <tag16h5.h>
#include <tag25h9.h>
#include <tag36h11.h>
#include <tagStandard41h12.h>

#include <array>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

constexpr std::array<FamilyMaker, 4> kFamilies{{
    {"tag36h11", true, tag36h11_create, tag36h11_destroy},
    {"tag25h9", true, tag25h9_create, tag25h9_destroy},
    {"tag16h5", true, tag16h5_create, tag16h5_destroy},
    {"tagStandard41h12", false, tagStandard41h12_create, tagStandard41h12_destroy},
}};

}  // namespace

const FamilyMaker& MakerOf(const std::string& family, const std::string& where) {
  std::string known;
  for (const FamilyMaker& maker : kFamilies) {
    if (family == maker.name) return maker;
    known += std::string(known.empty() ? "" : ", ") + maker.name;
  }
  throw base::InputError(where,
                         fmt::format("\"{}\" is not known; expected one of {}", family, known));
}

apriltag_family_t* CreateFamily(const FamilyMaker& maker, int black_border) {
  apriltag_family_t* family = maker.create();
  const int extra = black_border - 1;
  family->width_at_border += 2 * extra;
  family->total_width += 2 * extra;
  for (uint32_t i = 0; i < family->nbits; ++i) {  // counted from the border's outer corner
    family->bit_x[i] += extra;
    family->bit_y[i] += extra;
  }
  return family;
}

TagCells CellsOf(const FamilyMaker& maker, apriltag_family_t* family, int id) {
  TagCells tag;
  image_u8_t* image = apriltag_to_image(family, static_cast<uint32_t>(id));
  tag.cells = cv::Mat1b(image->height, image->width, image->buf, image->stride).clone();
  tag.margin = (family->total_width - family->width_at_border) / 2;
  image_u8_destroy(image);
  if (maker.turned_by_opencv) cv::flip(tag.cells, tag.cells, -1);  // by half a turn
  return tag;
}

}  // namespace softforce::vision
