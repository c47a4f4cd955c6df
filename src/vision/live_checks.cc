#include "vision/live_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "softforce/base/input_error.h"

namespace softforce::vision {

using base::InputError;

void CheckCameras(const std::vector<LiveCamera>& cameras) {
  if (cameras.empty()) {
    throw InputError("cameras", "there is none", "Name one with --camera NAME=SOURCE.");
  }
  std::set<std::string> names, sources;
  for (const LiveCamera& camera : cameras) {
    if (camera.name.empty() || !names.insert(camera.name).second) {
      throw InputError("cameras",
                       camera.name.empty()
                           ? fmt::format("the camera of \"{}\" has no name", camera.source)
                           : fmt::format("two cameras are called \"{}\"", camera.name),
                       "Give each camera a name of its own.");
    }
    if (!sources.insert(camera.source).second) {
      throw InputError("cameras",
                       fmt::format("two cameras have the same source \"{}\"", camera.source),
                       "Each camera needs a source of its own.");
    }
    if (!IsLive(camera.source)) {
      throw InputError(
          fmt::format("camera \"{}\"", camera.name),
          fmt::format("\"{}\" is no live camera, but stands for a file", camera.source),
          "Give a device (/dev/video0), a URL (rtsp://..., http://..., tcp://...) or a GStreamer "
          "pipeline (with \" ! \" between its elements).");
    }
    if (!std::isfinite(camera.time_offset_s)) {
      throw InputError(fmt::format("camera \"{}\"", camera.name), "its time offset is no number");
    }
  }
}

void LiveOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* range) {
    if (!holds) throw InputError(option, std::string("must be ") + range);
  };
  require(tolerance_s > 0, "--tolerance", "more than 0 s");
  require(max_wait_s > 0 && max_wait_s <= 10, "--max-wait", "more than 0 s, 10 s at most");
  require(queue >= 1 && queue <= 1000, "--queue", "1 to 1000 sets of pictures");
  require(open_timeout_s > 0, "--open-timeout", "more than 0 s");
  require(stall_s > 0, "--stall", "more than 0 s");
  require(settle_s > 0 && settle_s <= 60, "--settle", "more than 0 s, 60 s at most");
  require(longest_pause_s > 0, "longest pause", "more than 0 s");
  require(rate_hz >= 0, "--rate", "0 Hz or more");
  require(pixel_format.empty() || pixel_format.size() == 4, "--pixel-format",
          "four letters, as MJPG or YUYV");
}

}  // namespace softforce::vision
