#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/allocation/allocate.h"

namespace softforce::allocation {

// Where a feature point should be seen in one camera, if what is uncertain about the whole body
// turns out to be `delta`: at pixel + H delta, give or take `covariance`.
struct JointPrediction {
  int camera = 0;
  Eigen::Vector2d pixel;                       // px
  Eigen::Matrix<double, 2, Eigen::Dynamic> H;  // px per unit of delta
  Eigen::Matrix2d covariance;                  // px², of this feature alone
};

// A normal distribution of what is uncertain about the whole body.
struct Belief {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

struct JointOptions {
  AllocationOptions allocation;
  // Of a feature that should be seen; decides how readily features are left hidden.
  double detection_probability = 0.7;
  int max_hypotheses = 24;     // that are followed beside each other
  int refined_hypotheses = 6;  // of which so many are worked out in full

  void Check() const;  // throws InputError naming the option
};

struct JointAllocation {
  std::vector<AllocatedPixel> pixels;  // per prediction
  Belief belief;                       // given these
};

// Which detection belongs to which feature, in all cameras at once. The body moves as a whole: what
// one feature's detection says about `delta` narrows down where all others are, in every camera.
// Features are therefore decided on one after another, the clearest first, in several hypotheses
// beside each other, until all gates are as narrow as the features' own errors; then each camera is
// assigned as a whole about every hypothesis that is left (Allocate), and the most probable one is
// taken. A feature to which another hypothesis, not clearly less probable, gives another detection
// is ambiguous.
//
// `prior`: of delta, before anything was seen. `near`: where to look, if more is known about that
// than should count as evidence (a better linearisation of the same frame); no hypotheses are made
// then. `detections`: per camera.
JointAllocation AllocateJointly(const std::vector<JointPrediction>& predictions,
                                const Belief& prior,
                                const std::vector<std::vector<DetectedPixel>>& detections,
                                const JointOptions& options = {}, const Belief* near = nullptr);

// The most probable allocations that say different things about `delta`, best first, for a caller
// who can find out which is true; at most options.refined_hypotheses. Differences between them make
// nothing ambiguous.
std::vector<JointAllocation> ProposeJointly(
    const std::vector<JointPrediction>& predictions, const Belief& prior,
    const std::vector<std::vector<DetectedPixel>>& detections, const JointOptions& options = {});

}  // namespace softforce::allocation
