#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <string>

#include "vision/synthetic_picture.h"

namespace softforce::testing {

// The cells of a tag with its surroundings, 0 or 255, upright.
struct TagCells {
  cv::Mat1b cells;
  int margin;  // cells outside the square whose corners the detector gives
};

// Drawn by libapriltag, and turned by half a turn where OpenCV's aruco module draws the family so.
TagCells DrawTag(const std::string& family, int id);

using Corners = std::array<Eigen::Vector2d, 4>;  // px; TL TR BR BL

// A square seen upright, then turned clockwise by `angle`.
Corners SquareAt(const Eigen::Vector2d& middle, double side, double angle = 0);

void PaintTag(const TagCells& tag, const Corners& corners, SyntheticScene* scene);

}  // namespace softforce::testing
