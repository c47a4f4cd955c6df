#pragma once

#include <atomic>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "softforce/pipeline/mesh_convergence.h"
#include "softforce/pipeline/overlay_layers.h"
#include "softforce/pipeline/run_controls.h"
#include "softforce/pipeline/stage_times.h"
#include "softforce/pipeline/tracker.h"
#include "softforce/vision/live_cameras.h"
#include "softforce/vision/recorder.h"

namespace softforce::pipeline {

inline constexpr int kMaxThreads = 256;

struct RunOptions {
  std::filesystem::path out = "out";  // folder for the results; made if it is not there
  // Camera → file or live source; instead of those in the scene.
  std::map<std::string, std::string> sources;
  vision::LiveOptions live;
  std::map<std::string, double> time_offsets_s;  // camera → by how much its time stamps are late
  std::filesystem::path record;  // folder for the frames that are processed; empty: none
  double duration_s = std::numeric_limits<double>::infinity();  // of the frames' times
  int first_frame = 0;
  int end_frame = std::numeric_limits<int>::max();  // one past the last
  int every = 1;                                    // process every so many frames only
  int registration_frames =
      10;               // that are searched for base fiducials before the first frame is estimated
  int watch_rig = 1;    // look for a bump of the rig in every so many frames; 0: never
  bool overlay = true;  // write overlay.mp4
  bool frames = true;   // write frames.bin, from which `render` draws
  bool vtu = false;     // write a ParaView series
  bool report = true;   // write report.html
  bool show_progress = true;
  int overlay_width = 1920;  // px, of all cameras side by side
  OverlayLayers layers;      // that the overlay shows
  int threads = 0;           // that the stages share; 0: as many as the machine has cores
  MeshAim mesh_aim = MeshAim::kGiven;
  TrackerOptions tracker;  // model errors: for the given mesh; less of them is left if corrected
  // Set from outside: end after the frames in work, with complete files.
  const std::atomic<bool>* stop = nullptr;
  std::optional<int> serve_port;  // of the live page, on this machine; 0: any; nothing: no page
  bool view = false;              // show the run in a window; needs a display
  // What viewers ask for while it runs; nullptr: nobody does.
  RunControls* controls = nullptr;

  void Check() const;  // throws InputError naming the option
};

// What a run did, and whether its results can be relied on.
struct RunReport {
  int frames = 0;         // processed
  int usable_frames = 0;  // with forces
  std::vector<std::string> warnings;
  std::optional<FrameResult> last;  // frame with forces
  double seconds = 0;
  std::vector<StageTimes> stages;
  vision::SourceReport source;                     // how the cameras fared
  std::optional<vision::RecorderReport> recorded;  // if a recording was made
  bool live = false;
  bool has_pictures = true;  // false: of motion capture, and so no overlay
  std::filesystem::path out;

  // Whether the results can be relied on: the recording was whole and most frames gave forces.
  bool usable = false;

  std::string BriefReport() const;  // one line
  std::string FullReport() const;   // with tables of the last frame's forces and of the stages
};

// The main job: scene.yaml in, forces out. Reads the recording that the scene names, its live
// cameras or its points of motion capture, finds where the rig stands, estimates the forces in
// every frame, and writes forces.csv, markers.csv, actuation.csv, summary.json, overlay.mp4 and
// report.html.
// Files show up under their names only when they are complete. Stages run beside each other on
// threads; the tables do not depend on how many. Throws InputError for input that cannot be used,
// before anything is written where possible.
RunReport Run(const std::filesystem::path& scene_file, const RunOptions& options = {});

}  // namespace softforce::pipeline
