#pragma once

#include <string>

#include "softforce/report/calibration_report.h"

namespace softforce::report {

// The pictures of the page, each as SVG.

// What one camera saw: every point of the board, over cells that say how many.
std::string CoveragePlot(const CalibrationRecord& record, int camera);

// Its reprojection errors as arrows, magnified; a key says by how much.
std::string ResidualPlot(const CalibrationRecord& record, int camera);

// Its projection uncertainty over the picture, with numbers; colours from `lowest` to `highest` px.
std::string UncertaintyPlot(const CalibrationRecord& record, int camera, double lowest,
                            double highest);

// RMS of every picture as bars, a colour for each camera.
std::string PictureBars(const CalibrationRecord& record);

// Error of every held-out view as bars: on the board in mm, or in px if only one camera saw it.
std::string HoldOutBars(const CalibrationRecord& record);

// Distance and tilt of the board in every picture.
std::string PosePlot(const CalibrationRecord& record);

// Cameras and boards from above.
std::string TopView(const CalibrationRecord& record);

}  // namespace softforce::report
