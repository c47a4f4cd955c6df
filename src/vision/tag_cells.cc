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
  return CellsOf(maker, made.get(), id);
}

}  // namespace softforce::vision
