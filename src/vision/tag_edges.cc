#include "vision/tag_edges.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vision/edge_fit.h"
#include "vision/tag_look.h"

namespace softforce::vision {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;
using Sides = std::array<Edge, 4>;

// How far the lens bends the straight line between two pixels outward, as a function of the share
// of the way; a cubic, since over a tag a lens bends evenly.
std::function<double(double)> BendBetween(const camera::Lens& lens, const Eigen::Vector2d& from,
                                          const Eigen::Vector2d& to,
                                          const Eigen::Vector2d& outward) {
  const auto begin = camera::Unproject(lens, from);
  const auto end = camera::Unproject(lens, to);
  if (!begin || !end) return nullptr;
  std::array<double, 2> at{};
  for (int k = 0; k < 2; ++k) {
    const double t = k == 0 ? 0.25 : 0.75;
    const Eigen::Vector2d ray = (1 - t) * *begin + t * *end;
    const camera::Projection seen = camera::Project(lens, ray.homogeneous());
    if (!seen.visible) return nullptr;
    at[k] = outward.dot(seen.pixel - from);
  }
  const double even = 8.0 / 3 * (at[0] + at[1]), odd = 32.0 / 3 * (at[1] - at[0]);
  return [even, odd](double t) { return t * (1 - t) * (even + odd * (t - 0.5)); };
}

// Where to look for a side, and how wide a cell is there, px across the side.
struct SideSearch {
  EdgeSearch edge;
  double cell;
};

SideSearch SearchFor(const Corners& corners, int side, const TagPrint& print) {
  const int cells = print.cells.cells.cols - 2 * print.cells.margin;
  SideSearch search;
  EdgeSearch& edge = search.edge;
  edge.from = corners[side];
  edge.to = corners[(side + 1) % 4];
  const double length = (edge.to - edge.from).norm();
  const Eigen::Vector2d along = (edge.to - edge.from) / length;
  const Eigen::Vector2d inward =
      0.5 * (corners[(side + 2) % 4] + corners[(side + 3) % 4] - edge.from - edge.to);
  edge.outward = Eigen::Vector2d(along.y(), -along.x());
  if (edge.outward.dot(inward) > 0) edge.outward = -edge.outward;
  edge.end_margin = std::min(2.5, 0.1 * length);
  edge.rise = print.reversed ? -1 : 1;
  if (print.lens != nullptr) {
    edge.bend = BendBetween(*print.lens, edge.from, edge.to, edge.outward);
  }
  search.cell = -edge.outward.dot(inward) / cells;
  return search;
}

// The border is one cell wide on either side; the code's own edges begin there.
double Reach(double cell, double kept_off) { return std::clamp(cell - kept_off, 1.3, 3.5); }

std::optional<Sides> FitSides(const cv::Mat& grey, const Corners& corners, const TagPrint& print) {
  constexpr double kBlur = 1.5;  // px that a sharp edge spreads over to either side
  Sides sides;
  for (int i = 0; i < 4; ++i) {
    SideSearch search = SearchFor(corners, i, print);
    search.edge.reach = Reach(search.cell, kBlur);
    const std::optional<Edge> side = FitEdge(grey, search.edge);
    if (!side) return std::nullopt;
    sides[i] = *side;
  }
  return sides;
}

// Where cells are too small to fit a side without regard to the code: the levels of the darkest and
// the brightest parts of the tag, and the blur of the usual lens.
Sides NominalSides(const cv::Mat& grey, const Corners& corners, bool reversed) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& p : corners) points.emplace_back(p.x(), p.y());
  const cv::Mat part = grey(cv::boundingRect(points) & cv::Rect(0, 0, grey.cols, grey.rows));
  std::vector<uchar> values;
  for (int y = 0; y < part.rows; ++y) {
    values.insert(values.end(), part.ptr<uchar>(y), part.ptr<uchar>(y) + part.cols);
  }
  std::sort(values.begin(), values.end());
  Edge side{};
  side.blur = BlurPrior().mean;
  if (!values.empty()) {
    side.inside = values[values.size() / 10];
    side.outside = values[values.size() * 9 / 10];
  }
  if (reversed) std::swap(side.inside, side.outside);
  return {side, side, side, side};
}

// The light beyond the tag's paper next to a side, against the side's own levels.
double LightAround(const cv::Mat& grey, const SideSearch& search, const Edge& side, int margin,
                   double blur) {
  constexpr int kSamples = 9;
  std::vector<int> values;
  for (int k = 0; k < kSamples; ++k) {
    const double t = (k + 0.5) / kSamples;
    const Eigen::Vector2d p = (1 - t) * search.edge.from + t * search.edge.to +
                              (margin * search.cell + 2.5 * blur) * search.edge.outward;
    const auto x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (x < 0 || y < 0 || x >= grey.cols || y >= grey.rows) continue;
    values.push_back(grey.at<uchar>(y, x));
  }
  if (values.empty()) return 1;
  const auto median = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), median, values.end());
  return std::clamp((*median - side.inside) / (side.outside - side.inside), -0.5, 1.5);
}

// The sides once more, with what a first fit tells.
std::optional<Sides> FitSidesAgain(const cv::Mat& grey, const Corners& corners,
                                   const TagPrint& print, const Sides& before) {
  constexpr double kBlurSpread = 0.1;  // px; opposite sides are blurred alike, also by motion
  constexpr double kBlursKeptOff = 1.5;
  std::array<SideSearch, 4> searches;
  std::array<double, 4> around{};
  double blur = 0;
  for (const Edge& side : before) blur += 0.25 * side.blur;
  for (int i = 0; i < 4; ++i) {
    searches[i] = SearchFor(corners, i, print);
    around[i] = LightAround(grey, searches[i], before[i], print.cells.margin, blur);
  }
  const TagLook look(print.cells, print.reversed, corners, blur, around);
  Sides sides;
  for (int i = 0; i < 4; ++i) {
    EdgeSearch& search = searches[i].edge;
    search.reach = Reach(searches[i].cell, kBlursKeptOff * blur);
    search.blur = {0.5 * (before[i].blur + before[(i + 2) % 4].blur), kBlurSpread};
    const double rise = before[i].outside - before[i].inside;
    search.stray = [&](const Eigen::Vector2d& p) {
      const double v = search.outward.dot(p - search.from);
      return rise * (look.LightAt(p) - 0.5 * std::erfc(-v / (blur * M_SQRT2)));
    };
    const std::optional<Edge> side = FitEdge(grey, search);
    if (!side) return std::nullopt;
    sides[i] = *side;
  }
  return sides;
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
bool LookAlike(const Sides& sides) {
  constexpr double kMaxLevelChange = 0.3;  // of the contrast; light may fall unevenly
  constexpr double kMaxBlurRatio = 1.5;    // of opposite sides; motion blurs these alike
  constexpr double kMaxNoiseRatio = 3;     // of the mean of the other three
  constexpr double kMinNoise = 1;          // grey levels
  constexpr double kMinMisfit = 0.01;      // of the contrast: no edge is exactly a blurred step
  double inside = 0, outside = 0;
  for (const Edge& side : sides) {
    inside += 0.25 * side.inside;
    outside += 0.25 * side.outside;
  }
  const double least = std::max(kMinNoise, kMinMisfit * std::abs(outside - inside));
  double noise = 0;
  for (const Edge& side : sides) noise += std::max(side.noise, least);
  const double allowed = kMaxLevelChange * std::abs(outside - inside);
  for (int i = 0; i < 4; ++i) {
    const double others = (noise - std::max(sides[i].noise, least)) / 3;
    if (sides[i].noise > kMaxNoiseRatio * others) return false;
    if (std::abs(sides[i].inside - inside) > allowed) return false;
    if (std::abs(sides[i].outside - outside) > allowed) return false;
    if (sides[i].blur > kMaxBlurRatio * sides[(i + 2) % 4].blur) return false;
  }
  return true;
}

// How many times larger the covariance is than that of noise which is independent and alike in all
// pixels. What chance makes of 1 is left at 1.
double Inflation(const Sides& sides) {
  double clustering = 0, pieces = 0, roughness = 0, pixels = 0;
  for (const Edge& side : sides) {
    clustering += 0.25 * side.clustering;
    pieces += side.pieces - 2;
    roughness += 0.25 * side.roughness;
    pixels += side.rough_pixels;
  }
  const auto significant = [](double ratio, double freedom) {
    return ratio > 1 + 2 * std::sqrt(2 / freedom) ? ratio : 1;
  };
  return significant(clustering, pieces) * significant(roughness, pixels);
}

std::optional<RefinedCorners> CornersOf(const Sides& sides) {
  const double inflation = Inflation(sides);
  RefinedCorners refined;
  for (int i = 0; i < 4; ++i) {
    if (!Intersect(sides[(i + 3) % 4], sides[i], &refined.corners[i], &refined.covariances[i])) {
      return std::nullopt;
    }
    refined.covariances[i] *= inflation;
  }
  return refined;
}

double LargestChange(const Corners& before, const Corners& after) {
  double change = 0;
  for (int i = 0; i < 4; ++i) change = std::max(change, (after[i] - before[i]).norm());
  return change;
}

}  // namespace

std::optional<RefinedCorners> RefineCorners(const cv::Mat& grey, const Corners& corners,
                                            const TagPrint& print) {
  constexpr double kMaxChange = 3;    // px; more, and it is another edge
  constexpr double kSettled = 0.003;  // px
  constexpr int kMaxRounds = 6;
  std::optional<RefinedCorners> refined;
  std::optional<Sides> sides = FitSides(grey, corners, print);
  if (sides) refined = CornersOf(*sides);
  if (!refined) {
    sides = NominalSides(grey, corners, print.reversed);
    refined = RefinedCorners{corners, {}};
  }
  double change = kMaxChange;
  for (int round = 0; round < kMaxRounds && change > kSettled; ++round) {
    sides = FitSidesAgain(grey, refined->corners, print, *sides);
    if (!sides) return std::nullopt;
    const Corners before = refined->corners;
    refined = CornersOf(*sides);
    if (!refined) return std::nullopt;
    change = LargestChange(before, refined->corners);
  }
  if (!LookAlike(*sides) || !(LargestChange(corners, refined->corners) <= kMaxChange)) {
    return std::nullopt;
  }
  return refined;
}

}  // namespace softforce::vision
