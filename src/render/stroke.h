#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "render/depth_buffer.h"
#include "render/view.h"

namespace softforce::render {

// A piece of a line in space as it is seen: all of it hidden by the body, or none.
struct Stroke {
  std::vector<cv::Point2d> points;  // px, at least two
  bool hidden = false;
};

// px, at a share of the way in the picture.
inline cv::Point2d Along(const Sight& a, const Sight& b, double share) {
  return share == 1 ? b.pixel : a.pixel + share * (b.pixel - a.pixel);
}

// Cuts the line from a to b where the body begins or ceases to hide it: calls `use` with the shares
// of the way at which a part begins and ends, and whether it is hidden. Both ends must be visible
// to the lens; between them the line is taken as straight.
template <typename Use>
void ForEachPart(const DepthBuffer& depth, const Sight& a, const Sight& b, const Use& use) {
  constexpr double kTestEvery = 2;  // px
  const int steps =
      std::max(1, static_cast<int>(std::ceil(cv::norm(b.pixel - a.pixel) / kTestEvery)));
  double begin = 0;
  bool hidden = false;
  for (int i = 0; i < steps; ++i) {
    const double middle = (i + 0.5) / steps;
    const bool here = depth.Hides(Along(a, b, middle),
                                  a.inverse_depth + middle * (b.inverse_depth - a.inverse_depth));
    if (i > 0 && here != hidden) {
      const double end = static_cast<double>(i) / steps;
      use(begin, end, hidden);
      begin = end;
    }
    hidden = here;
  }
  use(begin, 1.0, hidden);
}

// A path in space (m, robot frame), cut so and bent as the lens bends it.
std::vector<Stroke> TracePath(const View& view, const DepthBuffer& depth,
                              const std::vector<Eigen::Vector3d>& path);

}  // namespace softforce::render
