#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/allocation/allocate.h"

namespace softforce::allocation {

// The best assignment of detections to features (rows). `distances2`: features × detections,
// squared Mahalanobis distance within the gate, infinity elsewhere. Leaving a feature hidden costs
// as much as a detection at the edge of the gate.
std::vector<AllocatedPixel> AssignGated(const Eigen::MatrixXd& distances2, double gate,
                                        double min_margin);

}  // namespace softforce::allocation
