#pragma once

#include <string>
#include <vector>

#include "softforce/calibration/calibrate.h"
#include "softforce/vision/board.h"

namespace softforce::report {

// A picture that did not become part of a view, or none of one that was used.
struct LeftOutPicture {
  int camera = -1;
  std::string name;
  std::string why;  // "no board found", "blurred", …
};

// All that a calibration's report tells of.
struct CalibrationRecord {
  vision::Board board;
  calibration::CalibrationInput input;
  calibration::Calibration result;
  std::vector<LeftOutPicture> left_out;
};

// One line: the verdict and the figures that matter.
std::string BriefReport(const CalibrationRecord& record);

// For the terminal: verdict, a table of the cameras, parameters with their standard deviations,
// held-out views, what was left out, advice.
std::string FullReport(const CalibrationRecord& record);

// The same and more as one HTML page with pictures (inline SVG). It needs no other file and no
// network.
std::string CalibrationPage(const CalibrationRecord& record);

}  // namespace softforce::report
