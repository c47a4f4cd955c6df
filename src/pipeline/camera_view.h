#pragma once

#include <limits>
#include <vector>

#include "softforce/pipeline/observe.h"

namespace softforce::pipeline {

// How one camera should see a feature.
struct View {
  bool expected = false;           // see IsExpected
  Eigen::Vector2d pixel;           // of the detection: the centroid of a dot's picture
  Eigen::Vector2d centroid_shift;  // px; centroid − projection of the centre
  Eigen::Matrix<double, 2, 3> J;   // d pixel / d p_robot, px/m
  double diameter_px = 0;
};

// What one camera should see of all features, and what it saw that could be one.
struct CameraView {
  std::vector<View> features;
  std::vector<int> expected;                                 // features this camera should see
  double nearest = std::numeric_limits<double>::infinity();  // m, depth of the nearest of them
  std::vector<int> kept;                                     // dots of the right size
  std::vector<allocation::DetectedPixel> detections;         // the same
};

// `c` is the camera's number in the rig.
CameraView ViewOf(int c, const camera::Camera& camera, const Eigen::Isometry3d& T_rig_robot,
                  const std::vector<PredictedFeature>& predicted, const CameraDetections& seen,
                  const ObserveOptions& options, const DotLook& look = {});

// Whether a camera should see a feature: it is in its picture, turned towards it, and the body is
// not in the way.
bool IsExpected(int c, const camera::Camera& camera, const Eigen::Isometry3d& T_rig_robot,
                const PredictedFeature& feature, const ObserveOptions& options);

}  // namespace softforce::pipeline
