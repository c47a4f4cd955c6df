#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "softforce/camera/lens.h"
#include "softforce/vision/tag_cells.h"

namespace softforce::vision {

struct RefinedCorners {
  std::array<Eigen::Vector2d, 4> corners;      // px
  std::array<Eigen::Matrix2d, 4> covariances;  // px²
};

// A tag as it is printed, and the lens that it is seen through.
struct TagPrint {
  TagCells cells;
  bool reversed;             // bright inside of the square's sides and dark outside
  const camera::Lens* lens;  // null: as if straight lines stayed straight
};

// Sharper corners of a tag whose corners are known to about a pixel: a blurred step is fitted to
// each side, neighbouring sides are intersected. Then once more, with what is known by now: the
// blur that the sides share, and the light that the code, the other sides and the surroundings of
// the paper throw across each side. Corners themselves are never looked at, being rounded by blur.
// `corners` go around the square as in Tag. Nothing if an edge cannot be measured: it is clipped,
// covered, or not there.
std::optional<RefinedCorners> RefineCorners(const cv::Mat& grey,
                                            const std::array<Eigen::Vector2d, 4>& corners,
                                            const TagPrint& print);

}  // namespace softforce::vision
