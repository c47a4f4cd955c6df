#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <string>

#include "softforce/vision/tag_cells.h"
#include "vision/synthetic_picture.h"

namespace softforce::testing {

using Corners = std::array<Eigen::Vector2d, 4>;  // px; TL TR BR BL

// A square seen upright, then turned clockwise by `angle`.
Corners SquareAt(const Eigen::Vector2d& middle, double side, double angle = 0);

void PaintTag(const vision::TagCells& tag, const Corners& corners, SyntheticScene* scene);

}  // namespace softforce::testing
