#pragma once

#include <string>
#include <vector>

#include "softforce/calibration/match_markers.h"
#include "softforce/pipeline/world.h"
#include "softforce/vision/frame_source.h"

namespace softforce::pipeline {

struct MarkerPlacement {
  vision::RigPose pose;
  std::string how;  // "by 12 of 14 dots"
  std::vector<std::string> warnings;
};

// Where the nodes of the body are under what its actuators are told, and its weight. Throws
// InputError if it has no equilibrium.
Eigen::Matrix3Xd UnloadedBody(const World& world, const scene::Scene& scene, double time_s);

// Where the rig stands, from the markers of a body on which nothing but its actuators and its own
// weight acts, in one frame. Dots are matched without labels; tags have ids. Throws InputError,
// with advice, if they do not tell it, or not for sure.
MarkerPlacement PlaceByMarkers(const scene::Scene& scene, const camera::Rig& rig,
                               const vision::FrameSet& frame,
                               const calibration::MatchOptions& options);

}  // namespace softforce::pipeline
