#pragma once

#include <Eigen/Core>
#include <string>

#include "softforce/pipeline/calibrate.h"

namespace softforce::pipeline {

// How far a projection may be off due to a calibration, in the camera where it is worst.
struct Certainty {
  bool known = false;  // the views determine the cameras
  std::string reason;  // why not; empty if known
  int camera = -1;     // the least certain one
  // px, standard deviation in the worst direction at the working distance: nine tenths of the
  // picture stay below. The outermost corners, where a board can hardly be seen, do not decide.
  double sd_px = NAN;
  Eigen::Vector2d worst = Eigen::Vector2d::Constant(NAN);  // px, where it is largest
  double distance = NAN;                                   // m

  bool Within(double limit_px) const { return known && sd_px <= limit_px; }

  // "left: the projection is uncertain by 0.31 px (nine tenths of the picture, 0.45 m away)"
  std::string Text(const calibration::CalibrationInput& input) const;
};

Certainty CertaintyOf(const calibration::Calibration& calibration);

// Follows it while views are collected. It calibrates anew, without holding views out, when an
// eighth more views have come, so that the work for n views is that of some 8 log n calibrations.
class CertaintyWatch {
 public:
  explicit CertaintyWatch(const CalibrateOptions& options);

  // By the latest calibration, with all of the views or nearly all.
  const Certainty& Of(const calibration::CalibrationInput& input);

 private:
  CalibrateOptions options_;
  Certainty last_;
  int next_ = 0;  // views at which it calibrates again
};

}  // namespace softforce::pipeline
