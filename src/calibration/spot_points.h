#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/calibration/match_markers.h"

namespace softforce::calibration {

// The places in space (m, rig frame) at which two cameras agree to see a spot, wrong ones among
// them where spots lie by chance on each other's epipolar lines.
std::vector<Eigen::Vector3d> PointsOfSpots(const camera::Rig& rig,
                                           const std::vector<std::vector<DetectedSpot>>& spots,
                                           const MatchOptions& options);

}  // namespace softforce::calibration
