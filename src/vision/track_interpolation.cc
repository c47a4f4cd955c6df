#include "vision/track_interpolation.h"

#include <algorithm>

namespace softforce::vision {

std::optional<Interpolated> Interpolate(const std::vector<TimedPixel>& track, double time_s,
                                        double longest_gap_s) {
  const auto after = std::upper_bound(track.begin(), track.end(), time_s,
                                      [](double t, const TimedPixel& p) { return t < p.time_s; });
  const auto index = after - track.begin();
  if (index < 2 || index + 2 > static_cast<std::ptrdiff_t>(track.size())) return std::nullopt;
  Interpolated at{static_cast<size_t>(index - 2), {}, {}, {0, 0}, {0, 0}};
  const TimedPixel* p = &track[at.from];
  for (int i = 0; i < 3; ++i) {
    if (p[i + 1].time_s - p[i].time_s > longest_gap_s) return std::nullopt;
  }
  for (int i = 0; i < 4; ++i) {  // Lagrange's polynomials and their derivatives
    double denominator = 1, weight = 1, slope = 0;
    for (int j = 0; j < 4; ++j) {
      if (j == i) continue;
      denominator *= p[i].time_s - p[j].time_s;
      slope = slope * (time_s - p[j].time_s) + weight;
      weight *= time_s - p[j].time_s;
    }
    at.weights[i] = weight / denominator;
    at.slopes[i] = slope / denominator;
    at.pixel += at.weights[i] * p[i].pixel;
    at.velocity += at.slopes[i] * p[i].pixel;
  }
  return at;
}

}  // namespace softforce::vision
