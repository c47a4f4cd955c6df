#pragma once

#include <string>

namespace softforce::pipeline {

// Why no window can be opened, for a person; empty if one can. OpenCV's windows end the program
// where there is no display.
std::string WhyNoDisplay();

}  // namespace softforce::pipeline
