#pragma once

#include <filesystem>

#include "pipeline/report_log.h"
#include "pipeline/summary_file.h"

namespace softforce::pipeline {

// report.html: the whole run on one page.
void WriteRunPage(const RunFacts& facts, const ReportLog& log, const std::filesystem::path& file);

}  // namespace softforce::pipeline
