#pragma once

#include <atomic>
#include <limits>

#include "calibration/estimate.h"

namespace softforce::calibration {

struct AdjustOptions {
  // The loss is Cauchy's beyond this length of the whitened error; infinite: least squares.
  double loss_scale = std::numeric_limits<double>::infinity();
  int free_distortion = 8;  // so many of the distortion parameters, at most; the rest are kept
  bool free_centre = true;  // principal points
  bool free_warp = true;
  int max_iterations = 100;
  double tolerance = 1e-12;  // relative change of the cost and of the parameters
  const std::atomic<bool>* stop = nullptr;
};

struct Adjustment {
  bool usable = false;
  bool converged = false;
  bool stopped = false;
};

// Bundle adjustment of an estimate to the sightings that are used, from where it stands. Views
// without any keep their pose.
Adjustment Adjust(const BoardShape& board, const std::vector<Sighting>& sightings,
                  const AdjustOptions& options, Estimate* estimate);

// The same with a robust loss whose scale follows the noise, so that a start that is tens of pixels
// off and outliers both do no harm.
Adjustment AdjustRobustly(const BoardShape& board, const std::vector<Sighting>& sightings,
                          AdjustOptions options, Estimate* estimate);

}  // namespace softforce::calibration
