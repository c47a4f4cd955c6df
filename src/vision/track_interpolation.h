#pragma once

#include <array>
#include <optional>
#include <vector>

#include "softforce/vision/time_offset.h"

namespace softforce::vision {

// A place of a track between its pictures: a cubic through four of them.
struct Interpolated {
  size_t from;  // first of the four
  std::array<double, 4> weights, slopes;
  Eigen::Vector2d pixel, velocity;  // px, px/s
};

// Nothing outside of the track, and where pictures are further apart than `longest_gap_s`.
std::optional<Interpolated> Interpolate(const std::vector<TimedPixel>& track, double time_s,
                                        double longest_gap_s);

}  // namespace softforce::vision
