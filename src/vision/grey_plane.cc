#include "vision/grey_plane.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace softforce::vision {
namespace {

constexpr double kRounding2 = 1.0 / 12;  // grey levels², variance of rounding to whole levels

// How many pixels have each grey level: medians of whole numbers come without sorting.
struct Histogram {
  std::array<int, 256> count{};
  int total = 0;

  void Add(int level) {
    ++count[level];
    ++total;
  }
  int Median() const {
    int level = 0;
    for (int below = count[0]; below <= total / 2; below += count[level]) ++level;
    return level;
  }
};

// Median and, from the median distance to it, a standard deviation that outliers cannot raise.
std::pair<double, double> RobustLevel(const std::vector<const PatchPixel*>& pixels) {
  Histogram levels, distances;
  for (const PatchPixel* pixel : pixels) levels.Add(static_cast<int>(pixel->value));
  const int level = levels.Median();
  for (int v = 0; v < 256; ++v) distances.count[std::abs(v - level)] += levels.count[v];
  distances.total = levels.total;
  return {level, 1.48 * distances.Median()};
}

// Sums over the pixels that a plane explains, for the next one.
struct PlaneSums {
  double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
  double misfit_x = 0, misfit_y = 0, misfit = 0, square = 0;
  int count = 0;

  PlaneSums(const std::vector<const PatchPixel*>& pixels, const Eigen::Vector3d& plane,
            double limit) {
    for (const PatchPixel* pixel : pixels) {
      const double dx = pixel->d.x(), dy = pixel->d.y();
      const double off = pixel->value - (plane(0) * dx + plane(1) * dy + plane(2));
      if (std::abs(off) > limit) continue;
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
      x += dx;
      y += dy;
      misfit_x += off * dx;
      misfit_y += off * dy;
      misfit += off;
      square += off * off;
      ++count;
    }
  }
};

}  // namespace

std::optional<GreyPlane> FitGreyPlane(const std::vector<const PatchPixel*>& pixels, bool sloped) {
  constexpr int kMinPixels = 6;
  constexpr double kMinLimit = 1.5;  // grey levels
  if (static_cast<int>(pixels.size()) < kMinPixels) return std::nullopt;
  const auto [level, spread] = RobustLevel(pixels);
  GreyPlane plane{{0, 0, level}, Eigen::Matrix3d::Zero(), 0, 0};
  double limit = std::max(3 * spread, 2 * kMinLimit);
  for (int round = 0; round < 3; ++round) {
    const PlaneSums sums(pixels, plane.coefficients, limit);
    const int count = sums.count;
    if (count < kMinPixels) return std::nullopt;
    const int unknowns = sloped ? 3 : 1;
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b(0, 0, sums.misfit);
    if (sloped) {
      b.head<2>() << sums.misfit_x, sums.misfit_y;
      Eigen::Matrix3d A;
      A << sums.xx, sums.xy, sums.x, sums.xy, sums.yy, sums.y, sums.x, sums.y, count;
      inverse = A.inverse();
      if (!inverse.allFinite()) return std::nullopt;
    } else {
      inverse(2, 2) = 1.0 / count;
    }
    plane.coefficients += inverse * b;
    plane.noise2 = std::max((sums.square - b.dot(inverse * b)) / (count - unknowns), kRounding2);
    plane.covariance = plane.noise2 * inverse;
    plane.inlier_share = static_cast<double>(count) / static_cast<double>(pixels.size());
    limit = std::max(3.5 * std::sqrt(plane.noise2), kMinLimit);
  }
  return plane;
}

}  // namespace softforce::vision
