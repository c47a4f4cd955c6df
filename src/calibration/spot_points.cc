#include "calibration/spot_points.h"

#include <algorithm>

#include "softforce/camera/triangulate.h"

namespace softforce::calibration {
namespace {

// Triangulation refuses misfits beyond about four standard deviations.
constexpr double kGateInSds = 4;
// Dots of one size are seen by two cameras at distances and slants that differ no more than this.
constexpr double kMaxSizeRatio = 2.5;

camera::PixelObservation Blurred(int camera, const DetectedSpot& spot, double max_misfit_px) {
  const double sd = max_misfit_px / kGateInSds;
  return {camera, spot.pixel, spot.covariance + sd * sd * Eigen::Matrix2d::Identity()};
}

bool AlikeInSize(const DetectedSpot& a, const DetectedSpot& b) {
  if (!(a.long_axis > 0 && b.long_axis > 0)) return true;
  const double ratio = a.long_axis / b.long_axis;
  return ratio < kMaxSizeRatio && ratio > 1 / kMaxSizeRatio;
}

}  // namespace

std::vector<Eigen::Vector3d> PointsOfSpots(const camera::Rig& rig,
                                           const std::vector<std::vector<DetectedSpot>>& spots,
                                           const MatchOptions& options) {
  std::vector<Eigen::Vector3d> points;
  for (int a = 0; a < static_cast<int>(spots.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(spots.size()); ++b) {
      for (const DetectedSpot& in_a : spots[a]) {
        for (const DetectedSpot& in_b : spots[b]) {
          if (!AlikeInSize(in_a, in_b)) continue;
          const camera::Triangulation found = camera::Triangulate(
              rig,
              {Blurred(a, in_a, options.max_misfit_px), Blurred(b, in_b, options.max_misfit_px)});
          if (found.ok()) points.push_back(found.p_rig);
        }
      }
    }
  }
  return points;
}

}  // namespace softforce::calibration
