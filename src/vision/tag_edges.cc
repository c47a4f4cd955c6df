#include "vision/tag_edges.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/edge_fit.h"

namespace softforce::vision {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;

std::optional<Edge> FitSide(const cv::Mat& grey, const Corners& corners, int side, int cells,
                            double rise) {
  constexpr double kBlur = 1.5;  // px that a sharp edge spreads over to either side
  EdgeSearch search;
  search.from = corners[side];
  search.to = corners[(side + 1) % 4];
  const Eigen::Vector2d along = (search.to - search.from).normalized();
  const Eigen::Vector2d inward =
      0.5 * (corners[(side + 2) % 4] + corners[(side + 3) % 4] - search.from - search.to);
  search.outward = Eigen::Vector2d(along.y(), -along.x());
  if (search.outward.dot(inward) > 0) search.outward = -search.outward;
  // The border is one cell wide on either side; the code's own edges begin there.
  const double cell = -search.outward.dot(inward) / cells;  // px, across the edge
  search.reach = std::clamp(cell - kBlur, 1.3, 3.5);
  search.end_margin = std::min(2.5, 0.1 * (search.to - search.from).norm());
  search.rise = rise;
  return FitEdge(grey, search);
}

// Where two edges cross, and how sure that is.
bool Intersect(const Edge& before, const Edge& after, Eigen::Vector2d* corner,
               Eigen::Matrix2d* covariance) {
  // On an edge: outward·(p − middle) − b·along·(p − middle) = a.
  const Eigen::Vector2d n0 = before.outward - before.coefficients(1) * before.along;
  const Eigen::Vector2d n1 = after.outward - after.coefficients(1) * after.along;
  Eigen::Matrix2d normals;
  normals << n0.transpose(), n1.transpose();
  if (std::abs(normals.determinant()) < 0.1) return false;  // nearly parallel
  const Eigen::Matrix2d inverse = normals.inverse();
  *corner = inverse * Eigen::Vector2d(before.coefficients(0) + n0.dot(before.middle),
                                      after.coefficients(0) + n1.dot(after.middle));
  const Eigen::Vector2d variance(before.OffsetVariance(*corner), after.OffsetVariance(*corner));
  *covariance = inverse * variance.asDiagonal() * inverse.transpose();
  return true;
}

// Whether all sides look alike. One that something covers looks like another edge: between other
// levels, drawn out, or in two pieces that no single step fits.
bool LookAlike(const std::array<Edge, 4>& sides) {
  constexpr double kMaxLevelChange = 0.3;  // of the contrast; light may fall unevenly
  constexpr double kMaxBlurRatio = 1.5;    // of opposite sides; motion blurs these alike
  constexpr double kMaxNoiseRatio = 3;     // of the mean of the other three
  constexpr double kMinNoise = 1;          // grey levels
  double inside = 0, outside = 0, noise = 0;
  for (const Edge& side : sides) {
    inside += 0.25 * side.inside;
    outside += 0.25 * side.outside;
    noise += std::max(side.noise, kMinNoise);
  }
  const double allowed = kMaxLevelChange * std::abs(outside - inside);
  for (int i = 0; i < 4; ++i) {
    const double others = (noise - std::max(sides[i].noise, kMinNoise)) / 3;
    if (sides[i].noise > kMaxNoiseRatio * others) return false;
    if (std::abs(sides[i].inside - inside) > allowed) return false;
    if (std::abs(sides[i].outside - outside) > allowed) return false;
    if (sides[i].blur > kMaxBlurRatio * sides[(i + 2) % 4].blur) return false;
  }
  return true;
}

}  // namespace

std::optional<RefinedCorners> RefineCorners(const cv::Mat& grey, const Corners& corners, int cells,
                                            bool reversed) {
  constexpr double kMaxChange = 3;  // px; more, and it is another edge
  std::array<Edge, 4> sides;
  for (int i = 0; i < 4; ++i) {
    const std::optional<Edge> side = FitSide(grey, corners, i, cells, reversed ? -1 : 1);
    if (!side) return std::nullopt;
    sides[i] = *side;
  }
  if (!LookAlike(sides)) return std::nullopt;
  double clustering = 0;
  for (const Edge& side : sides) clustering += 0.25 * side.clustering;
  RefinedCorners refined;
  for (int i = 0; i < 4; ++i) {
    if (!Intersect(sides[(i + 3) % 4], sides[i], &refined.corners[i], &refined.covariances[i]) ||
        (refined.corners[i] - corners[i]).norm() > kMaxChange) {
      return std::nullopt;
    }
    refined.covariances[i] *= std::max(1.0, clustering);
  }
  return refined;
}

}  // namespace softforce::vision
