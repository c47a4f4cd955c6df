#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "softforce/pipeline/overlay_layers.h"
#include "softforce/pipeline/stage_times.h"

namespace softforce::pipeline {

struct RenderOptions {
  std::filesystem::path out;                   // the video; empty: overlay.mp4 among the results
  std::filesystem::path scene;                 // instead of the one that the run was made with
  std::map<std::string, std::string> sources;  // camera → video, instead of those of the run
  OverlayLayers layers;
  int overlay_width = 1920;  // px, of all cameras side by side
  int threads = 0;           // 0: as many as the machine has cores
  bool show_progress = true;
  const std::atomic<bool>* stop = nullptr;  // set from outside: end with the frames so far

  void Check() const;  // throws InputError naming the option
};

struct RenderReport {
  std::filesystem::path out;
  int frames = 0;
  double seconds = 0;                 // for the frames, without reading the scene
  double cpu_seconds = 0;             // of all threads in that time
  std::vector<std::string> warnings;  // inputs that are not those of the run any more
  std::vector<StageTimes> stages;

  std::string BriefReport() const;  // one line
  std::string FullReport() const;   // with the warnings
};

// Draws the overlay of a finished run again: from summary.json, which says where the scene and the
// videos are, frames.bin, and the videos. Throws InputError if something of this is gone, or does
// not fit.
RenderReport Render(const std::filesystem::path& results, const RenderOptions& options = {});

}  // namespace softforce::pipeline
