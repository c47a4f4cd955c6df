#pragma once

#include <atomic>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/live_cameras.h"
#include "softforce/vision/time_offset.h"

namespace softforce::pipeline {

struct TimeOffsetsOptions {
  std::map<std::string, std::string> sources;    // camera → file or live source; not the scene's
  std::map<std::string, double> time_offsets_s;  // camera → s, to start from; not the rig's
  vision::LiveOptions live;
  double duration_s = std::numeric_limits<double>::infinity();  // of the frames' times
  vision::TimeOffsetOptions search;                             // around what the rig's file has
  const std::atomic<bool>* stop = nullptr;  // set from outside: what was seen so far counts

  void Check() const;  // throws InputError naming the option
};

struct TimeOffsetsReport {
  // What two cameras that see the same markers told of each other, beyond what was known.
  struct Link {
    int first = -1, second = -1;  // cameras of the rig
    int markers = 0;
    vision::TimeOffset found;
  };

  std::filesystem::path rig_file;
  camera::Rig rig;  // with the offsets found; those of the first camera stay
  int frames = 0;
  double seconds = 0;
  std::vector<Link> links;
  // The cameras whose offset was not found; none: it can be relied on.
  std::vector<std::string> unknown;

  bool usable() const { return unknown.empty(); }
  std::string FullReport() const;
};

// By how much each camera's time stamps are late against the first one's, from a recording, or live
// cameras, with the scene's markers moving. Cameras that do not see the same markers as the first
// are reached by others. Throws InputError for input that cannot be used; that nothing moves is an
// answer.
TimeOffsetsReport FindTimeOffsets(const std::filesystem::path& scene_file,
                                  const TimeOffsetsOptions& options);

}  // namespace softforce::pipeline
