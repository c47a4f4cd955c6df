#include "vision/edge_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vision/step_fit.h"

namespace softforce::vision {
namespace {

std::vector<BandPixel> CutBand(const cv::Mat& grey, const EdgeSearch& search,
                               const Eigen::Vector2d& middle, const Eigen::Vector2d& along,
                               double half_length) {
  constexpr double kMaxBend = 2;  // px
  const Eigen::Vector2d reach =
      half_length * along.cwiseAbs() + (search.reach + kMaxBend) * search.outward.cwiseAbs();
  const int x0 = std::max(0, static_cast<int>(std::ceil(middle.x() - reach.x())));
  const int x1 = std::min(grey.cols - 1, static_cast<int>(std::floor(middle.x() + reach.x())));
  const int y0 = std::max(0, static_cast<int>(std::ceil(middle.y() - reach.y())));
  const int y1 = std::min(grey.rows - 1, static_cast<int>(std::floor(middle.y() + reach.y())));
  const double length = (search.to - search.from).norm();
  std::vector<BandPixel> band;
  for (int y = y0; y <= y1; ++y) {
    const uchar* row = grey.ptr<uchar>(y);
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2d d = Eigen::Vector2d(x, y) - middle;
      const double u = along.dot(d);
      const double v = search.outward.dot(d);
      if (std::abs(u) > half_length) continue;
      const double on_line = search.bend ? v - search.bend(0.5 + u / length) : v;
      if (std::abs(on_line) > search.reach) continue;
      const double stray =
          search.stray ? search.stray(middle + d - (v - on_line) * search.outward) : 0;
      band.push_back({u, on_line, row[x] - stray});
    }
  }
  return band;
}

// Levels from the band's outer parts, at least a pixel wide so that some pixel lies in them.
std::optional<Step> Guess(const std::vector<BandPixel>& band, const EdgeSearch& search) {
  const double away = std::min(0.6 * search.reach, search.reach - 1.1);
  std::array<double, 2> sum{};
  std::array<int, 2> count{};
  for (const BandPixel& pixel : band) {
    if (std::abs(pixel.v) < away) continue;
    const size_t side = pixel.v > 0 ? 1 : 0;
    sum[side] += pixel.value;
    ++count[side];
  }
  if (count[0] < 4 || count[1] < 4) return std::nullopt;
  const double low = sum[0] / count[0];
  return Step{low, sum[1] / count[1] - low, search.blur.mean, 0, 0};
}

}  // namespace

double Edge::OffsetVariance(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d at(1, along.dot(p - middle));
  return at.dot(covariance * at);
}

std::optional<Edge> FitEdge(const cv::Mat& grey, const EdgeSearch& search) {
  constexpr double kMinHalfLength = 3;  // px
  constexpr double kMinRise = 15;       // grey levels
  const Eigen::Vector2d along = (search.to - search.from).normalized();
  const Eigen::Vector2d middle = 0.5 * (search.from + search.to);
  const double half_length = 0.5 * (search.to - search.from).norm() - search.end_margin;
  if (half_length < kMinHalfLength) return std::nullopt;
  const std::vector<BandPixel> band = CutBand(grey, search, middle, along, half_length);
  const std::optional<Step> guess = Guess(band, search);
  if (!guess || guess->rise * search.rise < kMinRise) return std::nullopt;
  const std::optional<FittedStep> fit =
      FitStep(band, *guess, half_length, search.reach, search.blur);
  if (!fit || fit->step.rise * search.rise < kMinRise) return std::nullopt;
  const Step& step = fit->step;
  Edge edge{middle,
            along,
            search.outward,
            {step.a, step.b},
            fit->covariance,
            fit->clustering,
            fit->pieces,
            fit->roughness,
            fit->rough_pixels,
            step.low,
            step.low + step.rise,
            step.blur,
            fit->noise};
  return edge;
}

}  // namespace softforce::vision
