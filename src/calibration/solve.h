#pragma once

#include "calibration/estimate.h"

namespace softforce::calibration {

// A calibration, and what it takes to hold views out.
struct Solved {
  Calibration calibration;
  std::vector<Sighting> sightings;
  Estimate estimate;
};

// All but the held-out error and the advice, for cameras whose lens models are given.
Solved Solve(const CalibrationInput& input, const BoardShape& board,
             const CalibrationOptions& options);

// Whether to stop, by options.stop; writes it into the result.
bool Stopped(const CalibrationOptions& options, Calibration* calibration);

// Passes on what begins, to options.on_progress.
void Tell(const CalibrationOptions& options, const std::string& what);

}  // namespace softforce::calibration
