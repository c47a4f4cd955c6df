#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/depth_buffer.h"
#include "render/view.h"

namespace softforce::render {

// A piece of a line in space as it is seen: all of it hidden by the body, or none.
struct Stroke {
  std::vector<cv::Point2d> points;  // px, at least two
  bool hidden = false;
};

// Cuts the line from a to b where the body begins or ceases to hide it. Both ends must be visible
// to the lens; between them the line is drawn straight.
std::vector<Stroke> CutByVisibility(const DepthBuffer& depth, const Sight& a, const Sight& b);

// The same for a path in space (m, robot frame), bent as the lens bends it.
std::vector<Stroke> TracePath(const View& view, const DepthBuffer& depth,
                              const std::vector<Eigen::Vector3d>& path);

}  // namespace softforce::render
