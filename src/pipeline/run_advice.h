#pragma once

#include <vector>

#include "pipeline/report_log.h"
#include "pipeline/run_tally.h"

namespace softforce::pipeline {

// What the frames of a run together say is wrong, and what may be done about it; the gravest first.
std::vector<report::RunAdvice> AdviceFor(const RunTally& tally, const ReportLog& log);

}  // namespace softforce::pipeline
