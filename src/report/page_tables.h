#pragma once

#include <string>

#include "softforce/report/calibration_report.h"

namespace softforce::report {

// The tables of the page, as HTML.
std::string CamerasTable(const CalibrationRecord& record);
std::string ValuesTable(const CalibrationRecord& record, int camera);  // −1: of the board
std::string TrialsTable(const CalibrationRecord& record);
std::string OutliersTable(const CalibrationRecord& record);
std::string LeftOutTable(const CalibrationRecord& record);
std::string ViewsTable(const CalibrationRecord& record);

}  // namespace softforce::report
