#pragma once

#include "softforce/report/calibration_report.h"

namespace softforce::report::testing {

// A calibration that went well, made up: two cameras, twelve views of a chessboard, one of its
// points an outlier, one view left out by the calibration, and one picture without a board.
CalibrationRecord MakeRecord();

// The same with one camera only: nothing to triangulate.
CalibrationRecord MakeSingleCameraRecord();

// Views that were too few: nothing was fitted.
CalibrationRecord MakeFailedRecord();

}  // namespace softforce::report::testing
