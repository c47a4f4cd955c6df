#pragma once

#include "calibration/fit.h"
#include "calibration/normal_equations.h"

namespace softforce::calibration {

// The sightings of all pictures with enough points.
std::vector<Sighting> MakeSightings(const CalibrationInput& input, int min_points);

// Held-out error by folds; each starts from `estimate`, and uses the sightings that are used. What
// is held out is measured by the sightings i with measured[i], so that lens models can be compared
// by the same points.
HoldOut RunHoldOut(const CalibrationInput& input, const BoardShape& board,
                   const CalibrationOptions& options, const std::vector<Sighting>& sightings,
                   const std::vector<char>& measured, const Estimate& estimate);

camera::Rig RigOf(const CalibrationInput& input, const Estimate& estimate);

// Values, covariance, fits of cameras and views, residuals, and uncertainty of the projection.
void Conclude(const CalibrationInput& input, const BoardShape& board,
              const CalibrationOptions& options, const std::vector<Sighting>& sightings,
              const Fit& fit, const NormalEquations& equations, const Estimate& estimate,
              Calibration* calibration);

// Fills `advice` from the rest of the result.
void Advise(const CalibrationInput& input, Calibration* calibration);

}  // namespace softforce::calibration
