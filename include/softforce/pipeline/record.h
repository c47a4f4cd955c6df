#pragma once

#include <atomic>
#include <filesystem>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/vision/live_cameras.h"
#include "softforce/vision/recorder.h"

namespace softforce::pipeline {

struct RecordOptions {
  std::map<std::string, std::string> sources;    // camera → live source
  std::map<std::string, double> time_offsets_s;  // camera → by how much its stamps are late
  std::filesystem::path out;                     // folder for the recording; must not hold one
  std::filesystem::path rig;  // optional rig.yaml: its cameras, with their resolutions
  cv::Size size;              // px, of every camera's pictures, where no rig says; empty: any
  double duration_s = std::numeric_limits<double>::infinity();
  vision::LiveOptions live;
  vision::RecorderOptions recorder;
  bool show_progress = true;
  const std::atomic<bool>* stop = nullptr;  // set from outside: end now, with complete files

  void Check() const;  // throws InputError naming the option
};

struct RecordReport {
  std::filesystem::path out;
  std::vector<std::string> cameras;
  vision::SourceReport source;
  vision::RecorderReport recorder;
  std::vector<std::string> messages;  // of cameras that went away, and the like

  bool usable() const { return recorder.written > 0; }
  std::string FullReport() const;
};

// Records live cameras until the duration is over or it is stopped. Throws InputError for cameras
// that cannot be opened and a folder that cannot be used, and if the disk is full.
RecordReport Record(const RecordOptions& options);

}  // namespace softforce::pipeline
