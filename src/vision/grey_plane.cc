#include "vision/grey_plane.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace softforce::vision {
namespace {

constexpr double kRounding2 = 1.0 / 12;  // grey levels², variance of rounding to whole levels

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Median and, from the median distance to it, a standard deviation that outliers cannot raise.
std::pair<double, double> RobustLevel(const std::vector<const PatchPixel*>& pixels) {
  std::vector<double> values;
  values.reserve(pixels.size());
  for (const PatchPixel* pixel : pixels) values.push_back(pixel->value);
  const double level = Median(&values);
  for (double& value : values) value = std::abs(value - level);
  return {level, 1.48 * Median(&values)};
}

}  // namespace

std::optional<GreyPlane> FitGreyPlane(const std::vector<const PatchPixel*>& pixels, bool sloped) {
  constexpr int kMinPixels = 6;
  constexpr double kMinLimit = 1.5;  // grey levels
  if (static_cast<int>(pixels.size()) < kMinPixels) return std::nullopt;
  const auto [level, spread] = RobustLevel(pixels);
  GreyPlane plane{{0, 0, level}, Eigen::Matrix3d::Zero(), 0, 0};
  double limit = std::max(3 * spread, 2 * kMinLimit);
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double square = 0;
    int count = 0;
    for (const PatchPixel* pixel : pixels) {
      const double misfit = pixel->value - plane.At(pixel->d);
      if (std::abs(misfit) > limit) continue;
      const Eigen::Vector3d at =
          sloped ? Eigen::Vector3d(pixel->d.homogeneous()) : Eigen::Vector3d(0, 0, 1);
      A += at * at.transpose();
      b += misfit * at;
      square += misfit * misfit;
      ++count;
    }
    if (count < kMinPixels) return std::nullopt;
    const int unknowns = sloped ? 3 : 1;
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    if (sloped) {
      inverse = A.inverse();
      if (!inverse.allFinite()) return std::nullopt;
    } else {
      inverse(2, 2) = 1 / A(2, 2);
    }
    plane.coefficients += inverse * b;
    plane.noise2 = std::max((square - b.dot(inverse * b)) / (count - unknowns), kRounding2);
    plane.covariance = plane.noise2 * inverse;
    plane.inlier_share = static_cast<double>(count) / static_cast<double>(pixels.size());
    limit = std::max(3.5 * std::sqrt(plane.noise2), kMinLimit);
  }
  return plane;
}

}  // namespace softforce::vision
