#include <fmt/format.h>

#include <charconv>
#include <memory>

#include "commands/camera_sources.h"
#include "commands/commands.h"
#include "commands/live_options.h"
#include "commands/stop.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/pipeline/record.h"

namespace softforce::apps {
namespace {

struct RecordArguments {
  std::vector<std::string> cameras;
  std::string out, rig, size, duration, segment;
  LiveArguments live;
  pipeline::RecordOptions options;
};

// "1280x1024", in px.
cv::Size ParseSize(const std::string& text) {
  cv::Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec == std::errc() && height.ptr == end && !size.empty()) return size;
  }
  throw base::InputError("--size", fmt::format("got \"{}\", expected WIDTHxHEIGHT in px", text),
                         "Example: --size 1280x1024");
}

double ParseTime(const std::string& text, const char* option) {
  return base::ParseQuantity(text, base::Dimension::kTime, 1, option)[0];
}

int Record(RecordArguments* arguments) {
  pipeline::RecordOptions& options = arguments->options;
  options.sources = ParseCameraSources(arguments->cameras);
  options.out = arguments->out;
  options.rig = arguments->rig;
  options.live = ParseLiveOptions(arguments->live);
  options.time_offsets_s = ParseTimeOffsets(arguments->live);
  if (!arguments->size.empty()) options.size = ParseSize(arguments->size);
  if (!arguments->duration.empty()) {
    options.duration_s = ParseTime(arguments->duration, "--duration");
  }
  if (!arguments->segment.empty()) {
    options.recorder.segment_s = ParseTime(arguments->segment, "--segment");
  }
  options.stop = StopOnSignal();
  const pipeline::RecordReport report = pipeline::Record(options);
  fmt::print("{}", report.FullReport());
  return report.usable() ? 0 : 1;
}

}  // namespace

Command AddRecord(CLI::App* program) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* app = program->add_subcommand("record", "Record live cameras together, without loss");
  app->add_option("--camera", arguments->cameras,
                  "NAME=SOURCE: a device (/dev/video0), a URL (rtsp://, http://, tcp://) or a "
                  "GStreamer pipeline; once for each camera")
      ->required()
      ->allow_extra_args(false);
  app->add_option("--out", arguments->out, "Folder for the recording; must be new or empty")
      ->required();
  app->add_option("--duration", arguments->duration,
                  "How long, as \"10 s\"; default: until Ctrl-C");
  app->add_option("--segment", arguments->segment,
                  fmt::format("Length of a video file, which is synced to the disk when it is "
                              "full; default \"{} s\"",
                              arguments->options.recorder.segment_s));
  app->add_option("--rig", arguments->rig,
                  "Rig file: record its cameras, at the resolutions that they are calibrated for");
  app->add_option(
      "--size", arguments->size,
      "Without --rig: WIDTHxHEIGHT of all pictures, px; default: what the cameras give");
  AddLiveOptions(app, &arguments->live);
  return {app, [arguments] { return Record(arguments.get()); }};
}

}  // namespace softforce::apps
