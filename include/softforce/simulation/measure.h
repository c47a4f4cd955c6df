#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace softforce::simulation {

// Markers that are lost from `from_s` up to `until_s`.
struct Dropout {
  double from_s = 0, until_s = std::numeric_limits<double>::infinity();
  std::vector<int> markers;  // numbers in the list; empty: all of them
};

// What a motion-capture system makes of markers.
struct MeasureOptions {
  double noise = 5e-5;      // m, standard deviation of each coordinate
  double hidden_share = 0;  // probability that a marker is hidden in a frame, each by itself
  std::vector<Dropout> dropouts;

  void Check() const;  // throws InputError naming the option
};

// Where the markers at `places` are measured in a frame; nothing for one that is hidden. Depends on
// the seed and on the frame's number only, not on frames before it; and whether a marker is hidden
// does not change the noise of the others.
std::vector<std::optional<Eigen::Vector3d>> MeasureMarkers(
    const std::vector<Eigen::Vector3d>& places, int frame, double time_s,
    const MeasureOptions& options, std::uint32_t seed);

}  // namespace softforce::simulation
