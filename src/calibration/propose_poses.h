#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "softforce/calibration/match_markers.h"

namespace softforce::calibration {

// A way to lay known dots onto points in space.
struct Proposal {
  Eigen::Isometry3d T_rig_robot;
  std::vector<int> point_of;  // per dot; −1: none
  int count = 0;              // dots with a point
  double rms = 0;             // m
};

// The rigid motion that takes the dots onto their points best; needs three of them.
Eigen::Isometry3d Align(const std::vector<KnownDot>& dots,
                        const std::vector<Eigen::Vector3d>& points,
                        const std::vector<int>& point_of);

// Proposals from triples of dots and of points with the same sides; each labelling once, those that
// explain most first.
std::vector<Proposal> ProposePoses(const camera::Rig& rig, const std::vector<KnownDot>& dots,
                                   const std::vector<Eigen::Vector3d>& points,
                                   const MatchOptions& options);

}  // namespace softforce::calibration
