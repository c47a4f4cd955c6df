#pragma once

#include <string>

#include "softforce/validation/study.h"

namespace softforce::report {

// The paper's simulated study as one HTML page with pictures (inline SVG): the figures of each
// table beside the paper's. It needs no other file and no network.
std::string StudyPage(const validation::Study& study);

}  // namespace softforce::report
