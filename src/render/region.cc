#include "render/region.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

namespace softforce::render {
namespace {

constexpr double kQuantile = 5.991;  // of χ² with 2 degrees of freedom, 95 %
constexpr int kCorners = 48;
constexpr double kSmallest = 2;  // px: an outline that small is hidden by what it surrounds

}  // namespace

std::vector<cv::Point2d> DrawRegion(Brush* brush, const View& view, const Eigen::Vector3d& place,
                                    const Eigen::Matrix3d& covariance, const cv::Vec3b& colour) {
  if (!place.allFinite() || !covariance.allFinite()) return {};
  const double size = std::sqrt(covariance.trace());
  const Sight centre = See(view, place);
  if (!(size > 0) || !centre.visible) return {};
  Eigen::Matrix<double, 2, 3> J;  // px/m
  for (int axis = 0; axis < 3; ++axis) {
    const Sight aside = See(view, place + size * Eigen::Vector3d::Unit(axis));
    if (!aside.visible) return {};
    const cv::Point2d step = (aside.pixel - centre.pixel) / size;
    J.col(axis) << step.x, step.y;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(J * covariance * J.transpose());
  const Eigen::Vector2d radii = (kQuantile * axes.eigenvalues().cwiseMax(0)).cwiseSqrt();
  if (radii(1) < kSmallest * view.unit) return {};
  std::vector<cv::Point2d> outline;
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    const Eigen::Vector2d at =
        axes.eigenvectors() * radii.cwiseProduct(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    outline.emplace_back(centre.pixel.x + at.x(), centre.pixel.y + at.y());
  }
  brush->PaintSeamed(colour, 1, 0.75 * view.unit,
                     [&](double extra) { brush->Polyline(outline, 1.5 * view.unit + extra); });
  return outline;
}

}  // namespace softforce::render
