#include "vision/step_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace softforce::vision {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

// Normal equations of the fit, linearised at `step`.
struct Normal {
  Matrix5d A = Matrix5d::Zero();
  Vector5d b = Vector5d::Zero();
  double square = 0;
  int used = 0;
  std::vector<double> misfits;  // of all pixels, absolute
};

// The share of the rise that is reached at a pixel, and how the value changes with z, grey levels.
struct ShareSlope {
  double share, slope;
};
ShareSlope ShareAndSlope(const Step& step, const BandPixel& pixel) {
  constexpr double kDensity = 0.39894228040143268;  // 1 / sqrt(2π)
  const double z = (pixel.v - step.a - step.b * pixel.u) / step.blur;
  return {0.5 * std::erfc(-z * M_SQRT1_2),
          step.rise * kDensity * std::exp(-0.5 * z * z) / step.blur};
}

Normal Linearise(const std::vector<BandPixel>& band, const Step& step, double limit) {
  Normal normal;
  for (const BandPixel& pixel : band) {
    const auto [share, slope] = ShareAndSlope(step, pixel);
    const double z = (pixel.v - step.a - step.b * pixel.u) / step.blur;
    const double misfit = pixel.value - step.low - step.rise * share;
    normal.misfits.push_back(std::abs(misfit));
    if (std::abs(misfit) > limit) continue;
    const Vector5d J(1, share, -slope * z, -slope, -slope * pixel.u);
    normal.A.selfadjointView<Eigen::Lower>().rankUpdate(J);
    normal.b += misfit * J;
    normal.square += misfit * misfit;
    ++normal.used;
  }
  normal.A = normal.A.selfadjointView<Eigen::Lower>();
  return normal;
}

void Apply(const Vector5d& change, Step* step) {
  step->low += change(0);
  step->rise += change(1);
  step->blur = std::clamp(step->blur + change(2), 0.3, 2.5);
  step->a += std::clamp(change(3), -1.0, 1.0);
  step->b += change(4);
}

// What makes the edge's place scatter more than independent noise, alike in all pixels, lets it.
struct Scatter {
  int pieces;
  double clustering = 1, roughness = 1, rough_pixels = 0;  // see FittedStep
};

// From the scores of short pieces of the edge: video compression errs alike in neighbouring pixels.
Scatter ScatterOf(const std::vector<BandPixel>& band, const Step& step, double half_length,
                  double limit, double noise2) {
  constexpr double kPiece = 4;  // px; compression works in blocks of 4 to 8
  Scatter scatter{std::max(3, static_cast<int>(2 * half_length / kPiece))};
  const int pieces = scatter.pieces;
  std::vector<double> score(pieces, 0.0);
  double independent = 0, weight = 0, weight2 = 0;
  for (const BandPixel& pixel : band) {
    const auto [share, slope] = ShareAndSlope(step, pixel);
    const double misfit = pixel.value - step.low - step.rise * share;
    if (std::abs(misfit) > limit) continue;
    const int piece = static_cast<int>(pieces * (0.5 + 0.5 * pixel.u / half_length));
    score[std::clamp(piece, 0, pieces - 1)] += slope * misfit;
    independent += slope * slope * misfit * misfit;
    weight += slope * slope;
    weight2 += slope * slope * slope * slope;
  }
  if (!(independent > 0)) return scatter;
  double together = 0;
  for (const double value : score) together += value * value;
  // Place and tilt are fitted; and blur, by what the pieces share.
  scatter.clustering = pieces / (pieces - 2.0) * together / independent;
  scatter.rough_pixels = weight * weight / weight2;
  const double freedom = std::max(scatter.rough_pixels - 3, 1.0) / scatter.rough_pixels;
  scatter.roughness = independent / (weight * noise2 * freedom);
  return scatter;
}

}  // namespace

// By Gauss–Newton; pixels that stand out (a stain, another edge) are left out.
std::optional<FittedStep> FitStep(const std::vector<BandPixel>& band, const Step& guess,
                                  double half_length, double reach, const BlurPrior& blur) {
  constexpr double kMinUsed = 0.75;  // share of the band that must be explained
  constexpr double kMaxTilt = 0.2;   // against the expected direction
  constexpr int kMaxIterations = 12;
  constexpr double kSettled = 2e-3;        // px
  constexpr double kSettledLevel = 0.5;    // grey levels
  constexpr double kRounding2 = 1.0 / 12;  // grey levels²
  Step step = guess;
  double limit = 0.5 * std::abs(step.rise);
  double noise2 = 1;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Normal normal = Linearise(band, step, limit);
    if (normal.used < kMinUsed * static_cast<double>(band.size()) || normal.used < 12) break;
    const double blur_weight = noise2 / (blur.spread * blur.spread);
    normal.A(2, 2) += blur_weight;
    normal.b(2) += blur_weight * (blur.mean - step.blur);
    const Vector5d change = normal.A.ldlt().solve(normal.b);
    if (!change.allFinite()) break;
    Apply(change, &step);
    noise2 = std::max(normal.square / (normal.used - 5), kRounding2);
    // From the median, which a stain over a part of the edge does not raise.
    const auto median = normal.misfits.begin() + static_cast<std::ptrdiff_t>(band.size() / 2);
    std::nth_element(normal.misfits.begin(), median, normal.misfits.end());
    limit = std::max(8 * *median, 3.0);  // five standard deviations
    if (std::abs(step.a) > reach || std::abs(step.b) > kMaxTilt) break;
    // The noise is that before the last change: the levels must have settled too.
    const bool settled = change.head<2>().cwiseAbs().maxCoeff() < kSettledLevel &&
                         std::abs(change(3)) + half_length * std::abs(change(4)) < kSettled;
    if (settled) {
      const Scatter scatter = ScatterOf(band, step, half_length, limit, noise2);
      return FittedStep{step,
                        noise2 * normal.A.inverse().bottomRightCorner<2, 2>(),
                        scatter.clustering,
                        scatter.pieces,
                        scatter.roughness,
                        scatter.rough_pixels,
                        std::sqrt(noise2)};
    }
  }
  return std::nullopt;
}

}  // namespace softforce::vision
