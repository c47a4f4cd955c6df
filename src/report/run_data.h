#pragma once

#include <string>

#include "softforce/report/run_report.h"

namespace softforce::report {

// The values behind a run's charts, and the body's views, as JSON for the page's scripts. It can
// stand inside an element <script>.
std::string ChartData(const RunRecord& record);
std::string BodyData(const RunRecord& record);

// One view for BodyData's body, with the `step` (m) that its displacements are counted in.
std::string OneView(const BodyView& view);

}  // namespace softforce::report
