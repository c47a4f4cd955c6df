#include "vision/dot_refinement.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vision/dot_misfit.h"
#include "vision/dot_patch.h"

namespace softforce::vision {
namespace {

// Coverage-weighted moments of the dot's picture, relative to the ellipse's centre.
struct Moments {
  double area = 0;  // px²
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();  // central, px²
};

// A pixel outside the contour that is far brighter (darker) than the dot's blur leaves it belongs
// to a neighbour; what is expected there stands in for it.
double OwnCoverage(const PatchPixel& pixel, const Levels& levels, double blur) {
  constexpr double kClearlyOutside = 0.8;  // px
  constexpr double kIntrusion = 0.15;      // of a pixel
  const double coverage = levels.Coverage(pixel);
  if (pixel.outside < kClearlyOutside || coverage < kIntrusion) return coverage;
  const double expected = ExpectedCoverage(pixel.outside, blur);
  const double noise = std::sqrt(levels.Noise(0)) / std::abs(levels.Contrast(pixel.d));
  return coverage > expected + kIntrusion + 4 * noise ? expected : coverage;
}

Moments MomentsOf(const Patch& patch, const Levels& levels, double blur) {
  Moments m;
  m.area = patch.inside;
  m.mean = patch.inside_sum;
  m.square = patch.inside_square;
  for (const PatchPixel* pixel : patch.edge) {
    const double coverage = OwnCoverage(*pixel, levels, blur);
    m.area += coverage;
    m.mean += coverage * pixel->d;
    m.square += coverage * pixel->d * pixel->d.transpose();
  }
  m.mean /= m.area;
  m.square = m.square / m.area - m.mean * m.mean.transpose();
  return m;
}

// The sharp ellipse behind a blurred one, and the blur (px, standard deviation, with the pixel's
// own). The blur adds its variance to both axes' moments and leaves the area alone, which gives it
// away.
std::optional<BlurredEllipse> Sharpen(const Ellipse& from, const Moments& m) {
  if (!(m.area > 1)) return std::nullopt;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(m.square);
  const Eigen::Vector2d variance = axes.eigenvalues();
  const double difference = variance(1) - variance(0);
  const double blur2 = 0.5 * (variance.sum() - std::hypot(difference, m.area / (2 * M_PI)));
  // Clutter would pass for a small dot under a large blur, at the cost of a large patch.
  constexpr double kMaxBlur = 2, kMaxBlurShare = 0.35;  // px; of the dot's mean radius, if larger
  const double max_blur2 =
      std::max(kMaxBlur * kMaxBlur, kMaxBlurShare * kMaxBlurShare * m.area / M_PI);
  const double blur2_bounded = std::clamp(blur2, 0.1, max_blur2);
  const Eigen::Vector2d half2 = 4 * (variance.array() - blur2_bounded);
  if (!(half2(0) > 0.25)) return std::nullopt;
  const Eigen::Matrix2d shape =
      axes.eigenvectors() * half2.asDiagonal() * axes.eigenvectors().transpose();
  return BlurredEllipse{Ellipse(from.centre() + m.mean, shape), std::sqrt(blur2_bounded)};
}

double ChangeBetween(const Ellipse& a, const Ellipse& b) {  // px
  return std::max({(a.centre() - b.centre()).norm(), std::abs(a.long_half() - b.long_half()),
                   std::abs(a.short_half() - b.short_half())});
}

// The centroid is Σ coverage·d / area; each edge pixel's noise moves it by its lever, and the
// errors of both planes move all edge pixels together.
Eigen::Matrix2d CentroidCovariance(const Patch& patch, const Levels& levels, const Moments& m) {
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, 3> of_ground = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> of_face = Eigen::Matrix<double, 2, 3>::Zero();
  for (const PatchPixel* pixel : patch.edge) {
    const double coverage = levels.Coverage(*pixel);
    const Eigen::Vector2d lever = (pixel->d - m.mean) / levels.Contrast(pixel->d);
    covariance += levels.Noise(coverage) * lever * lever.transpose();
    const Eigen::RowVector3d at = pixel->d.homogeneous().transpose();
    of_ground += (levels.own_slope ? 1 - coverage : 1.0) * lever * at;
    of_face += coverage * lever * at;
  }
  covariance += of_ground * levels.ground.covariance * of_ground.transpose();
  covariance += of_face * levels.face.covariance * of_face.transpose();
  return covariance / (m.area * m.area);
}

bool WithinBounds(const Ellipse& ellipse, double contrast, const DotOptions& options) {
  return 2 * ellipse.short_half() >= options.min_diameter &&
         2 * ellipse.long_half() <= options.max_diameter &&
         ellipse.short_half() >= options.min_axis_ratio * ellipse.long_half() &&
         std::abs(contrast) >= options.min_contrast &&
         (options.polarity == DotPolarity::kBoth ||
          (contrast > 0) == (options.polarity == DotPolarity::kBright));
}

}  // namespace

std::optional<Dot> MeasureDot(const cv::Mat& grey, const Ellipse& blob, const DotOptions& options) {
  constexpr int kMaxRounds = 5;
  constexpr double kSettled = 0.1;  // px, change of the ellipse in one round
  constexpr double kNearlyEnough = 0.8;
  constexpr double kByChance = 2;  // standard deviations
  constexpr double kBlursToEdge =
      2.8;  // this many blurs away from the contour, nothing is left of it
  BlurredEllipse now{blob, 1.0};
  for (int round = 1;; ++round) {
    const double margin = std::max(kBlursToEdge * now.blur, 1.8);  // px
    std::optional<Patch> patch = CutPatch(grey, now.ellipse, margin);
    if (!patch) return std::nullopt;
    const std::optional<Levels> levels = FitLevels(*patch);
    if (!levels) return std::nullopt;
    const double contrast = levels->Contrast(Eigen::Vector2d::Zero());
    // The contrast hardly changes from round to round; clutter of too little is not worth five.
    if (std::abs(contrast) < kNearlyEnough * options.min_contrast) return std::nullopt;
    const Moments moments = MomentsOf(*patch, *levels, now.blur);
    const std::optional<BlurredEllipse> sharper = Sharpen(now.ellipse, moments);
    if (!sharper) return std::nullopt;
    if (round < kMaxRounds && ChangeBetween(now.ellipse, sharper->ellipse) > kSettled) {
      now = *sharper;
      continue;
    }
    if (!WithinBounds(sharper->ellipse, contrast, options)) return std::nullopt;
    const Misfit misfit =
        MeasureMisfit(*patch, *levels, now.ellipse.centre(), *sharper, moments.area);
    if (misfit.area_share > options.max_ellipse_misfit) return std::nullopt;
    Dot dot;
    dot.centroid = sharper->ellipse.centre();
    // Compression roughens edges and smooths the ground that the noise is read from. Noise alone
    // makes an edge look rougher as often as smoother, which is no reason to trust it less.
    const bool rough = misfit.roughness > 1 + kByChance * misfit.chance;
    dot.covariance = (rough ? misfit.roughness : 1) * CentroidCovariance(*patch, *levels, moments);
    dot.long_axis = 2 * sharper->ellipse.long_half();
    dot.short_axis = 2 * sharper->ellipse.short_half();
    dot.contrast = contrast;
    return dot;
  }
}

}  // namespace softforce::vision
