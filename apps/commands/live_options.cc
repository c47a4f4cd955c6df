#include "commands/live_options.h"

#include <fmt/format.h>

#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"

namespace softforce::apps {
namespace {

using base::Dimension;

void Read(const std::string& text, Dimension dimension, const char* option, double* value) {
  if (!text.empty()) *value = base::ParseQuantity(text, dimension, 1, option)[0];
}

}  // namespace

void AddLiveOptions(CLI::App* app, LiveArguments* arguments) {
  const vision::LiveOptions defaults;
  app->add_option("--tolerance", arguments->tolerance,
                  "Live: pictures belong together if taken within this time, as \"5 ms\"; at most, "
                  "and by default, half the time between two pictures");
  app->add_option(
         "--time-offset", arguments->time_offsets,
         "NAME=TIME: by how much a camera's time stamps are late, as right=\"4 ms\", instead of "
         "what the rig file says; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--stall", arguments->stall,
                  fmt::format("Live: a camera that gives no picture for so long is opened again, "
                              "default \"{} s\"",
                              defaults.stall_s));
  app->add_option("--rate", arguments->rate,
                  "Live: pictures per second to ask a device (V4L2) for, as \"30 Hz\"; default its "
                  "own");
  app->add_option("--pixel-format", arguments->pixel_format,
                  "Live: format to ask a device (V4L2) for, as MJPG or YUYV; default its own");
}

vision::LiveOptions ParseLiveOptions(const LiveArguments& arguments) {
  vision::LiveOptions options;
  Read(arguments.tolerance, Dimension::kTime, "--tolerance", &options.tolerance_s);
  Read(arguments.stall, Dimension::kTime, "--stall", &options.stall_s);
  Read(arguments.rate, Dimension::kFrequency, "--rate", &options.rate_hz);
  options.pixel_format = arguments.pixel_format;
  options.Check();
  return options;
}

std::map<std::string, double> ParseTimeOffsets(const LiveArguments& arguments) {
  std::map<std::string, double> offsets;
  for (const std::string& text : arguments.time_offsets) {
    const size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == std::string::npos || name.empty() || offsets.count(name) > 0) {
      throw base::InputError("--time-offset",
                             offsets.count(name) > 0
                                 ? fmt::format("camera \"{}\" is given twice", name)
                                 : fmt::format("got \"{}\", expected NAME=TIME", text),
                             "Example: --time-offset right=\"4 ms\"");
    }
    Read(text.substr(equals + 1), Dimension::kTime, "--time-offset", &offsets[name]);
  }
  return offsets;
}

}  // namespace softforce::apps
