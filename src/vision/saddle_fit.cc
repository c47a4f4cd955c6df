#include "vision/saddle_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace softforce::vision {
namespace {

constexpr double kGuard = 1.5;  // px that blur carries another field's grey across its edge

constexpr double kBand = 4;  // px on either side of an edge in which every pixel counts

struct Sample {
  Eigen::Vector2d p;  // px
  double value;       // grey levels
};

enum Unknown { kX, kY, kAngle1, kAngle2, kLogBlur, kMean, kAmplitude, kLightX, kLightY, kCount };
using Vector = Eigen::Matrix<double, kCount, 1>;
using Matrix = Eigen::Matrix<double, kCount, kCount>;

// Share of `reach` that can be used when the pixels beyond it see something else.
double Guarded(double reach_m, double px_per_m, double least_px) {
  return std::max(reach_m - kGuard / px_per_m, least_px / px_per_m);
}

std::vector<Sample> Window(const cv::Mat& grey, const LocalMap& map, const CornerPrint& print,
                           const SaddleOptions& options) {
  const Eigen::Matrix2d J = map.Jacobian();
  const double per_u = J.col(0).norm(), per_v = J.col(1).norm();  // px/m
  const double max_u = std::min(options.max_reach, options.max_reach_px / per_u);
  const double max_v = std::min(options.max_reach, options.max_reach_px / per_v);
  std::array<Quadrant, 4> usable = print.quadrants;
  for (Quadrant& quadrant : usable) {
    quadrant.u = std::min(max_u, Guarded(quadrant.u, per_u, 2));
    quadrant.v = std::min(max_v, Guarded(quadrant.v, per_v, 2));
    quadrant.strip = Guarded(quadrant.strip, std::min(per_u, per_v), 1);
  }
  const Eigen::Vector2d corner = map.Pixel(Eigen::Vector2d::Zero());
  const double span = 1.5 * (max_u * per_u + max_v * per_v);
  const int x0 = std::max(0, static_cast<int>(corner.x() - span));
  const int x1 = std::min(grey.cols - 1, static_cast<int>(corner.x() + span) + 1);
  const int y0 = std::max(0, static_cast<int>(corner.y() - span));
  const int y1 = std::min(grey.rows - 1, static_cast<int>(corner.y() + span) + 1);
  std::vector<Sample> samples;
  for (int y = y0; y <= y1; ++y) {
    const uchar* row = grey.ptr<uchar>(y);
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2d offset = map.Offset(Eigen::Vector2d(x, y));
      const double u = std::abs(offset.x()), v = std::abs(offset.y());
      const Quadrant& quadrant = usable[(offset.x() > 0) + 2 * (offset.y() > 0)];
      if (u > quadrant.u || v > quadrant.v || std::min(u, v) > quadrant.strip) continue;
      // Far from both edges a pixel only tells the grey of its field; few are enough.
      const bool far = u * per_u > kBand && v * per_v > kBand;
      if (far && (x % 4 != 0 || y % 4 != 0)) continue;
      samples.push_back({Eigen::Vector2d(x, y), static_cast<double>(row[x])});
    }
  }
  return samples;
}

struct Linearised {
  Matrix A = Matrix::Zero();
  Vector b = Vector::Zero();
  double square = 0;
};

// The lines' normals are (cos, sin) of the angles; blur is kept positive by its logarithm.
Linearised Linearise(const std::vector<Sample>& samples, const Vector& x, bool derivatives) {
  const Eigen::Vector2d corner(x(kX), x(kY)), light(x(kLightX), x(kLightY));
  const Eigen::Vector2d n1(std::cos(x(kAngle1)), std::sin(x(kAngle1)));
  const Eigen::Vector2d n2(std::cos(x(kAngle2)), std::sin(x(kAngle2)));
  const double blur = std::exp(x(kLogBlur));
  const double slope = std::sqrt(2 / M_PI) / blur;  // of erf(s / √2 blur) at s = 0, 1/px
  Linearised result;
  Vector row;
  for (const Sample& sample : samples) {
    const Eigen::Vector2d d = sample.p - corner;
    const double s1 = n1.dot(d) / blur, s2 = n2.dot(d) / blur;
    const double e1 = std::erf(s1 * M_SQRT1_2), e2 = std::erf(s2 * M_SQRT1_2);
    const double lit = 1 + light.dot(d);
    const double printed = x(kMean) + x(kAmplitude) * e1 * e2;
    const double misfit = sample.value - lit * printed;
    result.square += misfit * misfit;
    if (!derivatives) continue;
    // Of the model by s₁ and s₂ in px.
    const double by1 = lit * x(kAmplitude) * e2 * slope * std::exp(-0.5 * s1 * s1);
    const double by2 = lit * x(kAmplitude) * e1 * slope * std::exp(-0.5 * s2 * s2);
    row.segment<2>(kX) = -by1 * n1 - by2 * n2 - printed * light;
    row(kAngle1) = by1 * (n1.x() * d.y() - n1.y() * d.x());
    row(kAngle2) = by2 * (n2.x() * d.y() - n2.y() * d.x());
    row(kLogBlur) = -blur * (by1 * s1 + by2 * s2);
    row(kMean) = lit;
    row(kAmplitude) = lit * e1 * e2;
    row.segment<2>(kLightX) = printed * d;
    result.A.selfadjointView<Eigen::Lower>().rankUpdate(row);
    result.b += misfit * row;
  }
  result.A = result.A.selfadjointView<Eigen::Lower>();
  return result;
}

// Nothing if it does not converge.
std::optional<Linearised> Minimise(const std::vector<Sample>& samples, Vector* x) {
  constexpr int kMaxSteps = 40;
  constexpr double kConverged = 1e-4;  // px
  Linearised here = Linearise(samples, *x, true);
  double damping = 1e-3;
  for (int step = 0; step < kMaxSteps; ++step) {
    Matrix A = here.A;
    A.diagonal() *= 1 + damping;
    const Vector dx = A.ldlt().solve(here.b);
    if (!dx.allFinite()) return std::nullopt;
    const Vector tried = *x + dx;
    const Linearised there = Linearise(samples, tried, true);
    if (there.square > here.square * (1 + 1e-12)) {
      damping *= 10;
      if (damping > 1e6) return std::nullopt;
      continue;
    }
    *x = tried;
    here = there;
    damping = std::max(0.1 * damping, 1e-9);
    if (dx.head<2>().norm() < kConverged && damping < 1e-2) return here;
  }
  return std::nullopt;
}

// Levels and blur to start from; the edges' directions are the map's.
Vector Start(const std::vector<Sample>& samples, const LocalMap& map, double sign) {
  Vector x = Vector::Zero();
  x.head<2>() = map.Pixel(Eigen::Vector2d::Zero());
  const Eigen::Matrix2d to_board = map.Jacobian().inverse();
  // The gradient of u in the picture is across the edge u = 0, and points where u grows.
  x(kAngle1) = std::atan2(to_board(0, 1), to_board(0, 0));
  x(kAngle2) = std::atan2(to_board(1, 1), to_board(1, 0));
  x(kLogBlur) = std::log(0.9);
  double sum = 0, difference = 0;
  for (const Sample& sample : samples) {
    const Eigen::Vector2d offset = map.Offset(sample.p);
    sum += sample.value;
    difference += offset.x() * offset.y() > 0 ? sample.value : -sample.value;
  }
  x(kMean) = sum / static_cast<double>(samples.size());
  x(kAmplitude) = difference / static_cast<double>(samples.size());
  if (x(kAmplitude) * sign < 0) x(kAmplitude) = 0;
  return x;
}

}  // namespace

std::optional<SaddleFit> FitSaddle(const cv::Mat& grey, const LocalMap& map,
                                   const CornerPrint& print, const SaddleOptions& options) {
  constexpr int kMinSamples = 30;
  constexpr double kMaxMisfit = 0.2;  // of the contrast
  const std::vector<Sample> samples = Window(grey, map, print, options);
  if (static_cast<int>(samples.size()) < kMinSamples) return std::nullopt;
  Vector x = Start(samples, map, print.sign);
  const Eigen::Vector2d start = x.head<2>();
  if (2 * std::abs(x(kAmplitude)) < 0.3 * options.min_contrast) return std::nullopt;
  const std::optional<Linearised> end = Minimise(samples, &x);
  if (!end) return std::nullopt;

  SaddleFit fit;
  fit.pixel = x.head<2>();
  fit.blur = std::exp(x(kLogBlur));
  fit.contrast = 2 * std::abs(x(kAmplitude));
  const double variance = end->square / static_cast<double>(samples.size() - kCount);
  fit.misfit = std::sqrt(variance);
  fit.covariance = (variance * end->A.inverse()).topLeftCorner<2, 2>();
  const Eigen::Matrix2d J = map.Jacobian();
  const double window = options.max_reach * std::min(J.col(0).norm(), J.col(1).norm());  // px
  const bool believable = x(kAmplitude) * print.sign > 0 && fit.contrast >= options.min_contrast &&
                          fit.misfit < kMaxMisfit * fit.contrast && fit.covariance.allFinite() &&
                          (fit.pixel - start).norm() < std::max(1.5, 0.5 * window) &&
                          fit.blur < std::max(1.5, 0.6 * window);
  if (!believable) return std::nullopt;
  return fit;
}

}  // namespace softforce::vision
