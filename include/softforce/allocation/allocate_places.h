#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/allocation/allocate.h"

namespace softforce::allocation {

// Where a feature point should be in space.
struct PredictedPlace {
  Eigen::Vector3d position;    // m
  Eigen::Matrix3d covariance;  // m², of the prediction alone
};

// A point in space that was measured as a whole.
struct DetectedPlace {
  Eigen::Vector3d position;    // m
  Eigen::Matrix3d covariance;  // m²
};

// As Allocate, of points that motion capture measured in space. `threshold_displacement`: the
// paper's, m; 0 turns it off. That of the options, which is in pixels, is not used.
std::vector<AllocatedPixel> AllocatePlaces(const std::vector<PredictedPlace>& predictions,
                                           const std::vector<DetectedPlace>& detections,
                                           double threshold_displacement,
                                           const AllocationOptions& options = {});

}  // namespace softforce::allocation
