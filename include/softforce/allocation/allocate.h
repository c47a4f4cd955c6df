#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace softforce::allocation {

// Where a feature point should be seen in one camera.
struct PredictedPixel {
  Eigen::Vector2d pixel;       // px
  Eigen::Matrix2d covariance;  // px², of the prediction alone
};

// What was seen in one camera.
struct DetectedPixel {
  Eigen::Vector2d pixel;       // px
  Eigen::Matrix2d covariance;  // px²
};

// How detections are given to features.
enum class Rule {
  kOptimal,  // the best assignment of all together, in gates of the prediction's covariance
  // The paper's (VII.A): a feature takes the detection nearest to it within the threshold
  // displacement, for comparison.
  kNearest
};

// The name of a rule in options and files: "optimal", "nearest".
const char* Name(Rule rule);

struct AllocationOptions {
  Rule rule = Rule::kOptimal;
  double gate_probability =
      0.999;  // share of right detections that the Mahalanobis gate lets through
  // The paper's threshold displacement, in pixels of this camera; 0 turns it off.
  double threshold_displacement_px = 0;
  // How much better the best assignment must be than any that gives a feature another detection, in
  // units of half χ²; closer calls are left hidden rather than guessed.
  double min_margin = 3.0;

  void Check() const;  // throws InputError naming the option
};

// One feature's result in one camera.
struct AllocatedPixel {
  enum class Status { kHidden, kSeen, kAmbiguous };

  Status status = Status::kHidden;
  int detection = -1;  // number of the detection; set if kSeen
  double distance2 =
      NAN;  // squared Mahalanobis distance of the innovation; set if kSeen or kAmbiguous
};

// Which detection belongs to which predicted feature, in one camera: each feature gets at most one
// detection within its gate and each detection goes to at most one feature, so that the total of
// squared Mahalanobis distances, with a price for leaving a feature hidden, is least (Hungarian
// assignment). Detections that nothing claims are clutter. Detections or predictions that are not
// finite are left out.
std::vector<AllocatedPixel> Allocate(const std::vector<PredictedPixel>& predictions,
                                     const std::vector<DetectedPixel>& detections,
                                     const AllocationOptions& options = {});

}  // namespace softforce::allocation
