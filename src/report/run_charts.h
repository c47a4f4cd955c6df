#pragma once

#include <string>

#include "softforce/report/run_report.h"

namespace softforce::report {

// The charts of a run over time, each as SVG with what the pointer needs to read it.

// Norms of all forces with their 95 % bands.
std::string NormChart(const RunRecord& record);

// x, y and z of one force with their 95 % bands.
std::string ComponentChart(const RunRecord& record, int force);

// chi2 per degree of freedom; empty if it is known nowhere.
std::string ResidualChart(const RunRecord& record);

// A row per marker with its status over time.
std::string MarkerTimeline(const RunRecord& record);

// Bars to the median, with a line to the 95 % quantile.
std::string StageBars(const RunRecord& record);

}  // namespace softforce::report
