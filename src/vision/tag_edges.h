#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

namespace softforce::vision {

struct RefinedCorners {
  std::array<Eigen::Vector2d, 4> corners;      // px
  std::array<Eigen::Matrix2d, 4> covariances;  // px²
};

// Sharper corners of a tag whose corners are known to about a pixel: along each side the place of
// the edge is measured in many profiles across it, a line is fitted to them, and neighbouring lines
// are intersected. Corners themselves are never looked at, being rounded by blur. `corners` go
// around the square; `cells` is the number of code cells along a side; a side is dark inside and
// bright outside, or the other way round if `reversed`. Nothing if an edge cannot be measured: it
// is clipped, covered, or not there.
std::optional<RefinedCorners> RefineCorners(const cv::Mat& grey,
                                            const std::array<Eigen::Vector2d, 4>& corners,
                                            int cells, bool reversed);

}  // namespace softforce::vision
