#pragma once

#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/rig_pose.h"

namespace softforce::calibration {

struct PairOptions {
  double pixel_sd = 0.5;  // px, of a typed or clicked pixel, each coordinate
  double max_misfit = 5;  // standard deviations, of a right pair
  int max_trials = 300;   // sets of four pairs to start from; more are sampled

  void Check() const;  // throws InputError naming the option
};

struct PairRegistration {
  enum class Status {
    kNotRun,
    kOk,
    kTooFewPoints,  // fewer than four places, or than four in every camera
    kCollinear,     // the places lie on a line
    kInconsistent,  // no more than half of the pairs fit together
    kCannotTell     // some do not fit, and it cannot be told which
  };

  Status status = Status::kNotRun;
  vision::RigPose pose;
  std::vector<char> wrong;        // per pair: does not fit the others, and was left out
  std::vector<double> misfit_px;  // per pair, distance

  bool ok() const { return status == Status::kOk; }
  int num_wrong() const;
};

// Where the rig stands, from points of known place in the robot frame and where cameras see them,
// some of which may be wrong (a sighting's own covariance is not used). Four pairs of one camera at
// a time propose a pose, and the one that most pairs agree with is refined by these.
PairRegistration RegisterByPairs(const camera::Rig& rig,
                                 const std::vector<vision::PointSighting>& pairs,
                                 const PairOptions& options = {});

}  // namespace softforce::calibration
