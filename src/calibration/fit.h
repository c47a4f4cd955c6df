#pragma once

#include "calibration/adjust.h"

namespace softforce::calibration {

// A bundle adjustment that has come to its end.
struct Fit {
  Adjustment adjustment;
  double noise_factor = NAN;   // root of χ² over degrees of freedom
  std::vector<double> sigmas;  // per sighting, its whitened error over the noise factor
};

// Sets `used` of the sightings: not those beyond what the noise allows with the given probability,
// and not the pictures of which more than half is beyond. Then adjusts by least squares, and again
// until both agree.
Fit FitWithoutOutliers(const BoardShape& board, double outlier_probability,
                       const AdjustOptions& options, std::vector<Sighting>* sightings,
                       Estimate* estimate);

// Root of χ² over degrees of freedom, of the sightings used.
double NoiseFactor(const BoardShape& board, const std::vector<Sighting>& sightings,
                   const Estimate& estimate);

}  // namespace softforce::calibration
