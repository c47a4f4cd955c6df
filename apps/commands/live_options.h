#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "softforce/vision/live_cameras.h"

namespace softforce::apps {

// The options of live cameras as they are written on the command line.
struct LiveArguments {
  std::string tolerance, stall, rate, pixel_format;
  std::vector<std::string> time_offsets;
};

void AddLiveOptions(CLI::App* app, LiveArguments* arguments);

// Throws InputError naming the option.
vision::LiveOptions ParseLiveOptions(const LiveArguments& arguments);
std::map<std::string, double> ParseTimeOffsets(const LiveArguments& arguments);  // camera → s

}  // namespace softforce::apps
