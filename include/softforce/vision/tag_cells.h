#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace softforce::vision {

// The cells of a tag with its surroundings, 0 or 255, upright as TagDetector means it.
struct TagCells {
  cv::Mat1b cells;
  int margin = 0;  // cells outside the square whose corners the detector gives
};

// As libapriltag draws it, its own white rim included. Throws InputError, naming `where`, for a
// family that TagDetector does not know, or an id that the family does not have. `black_border`:
// see TagOptions.
TagCells DrawTag(const std::string& family, int id, const std::string& where = "tag",
                 int black_border = 1);

}  // namespace softforce::vision
