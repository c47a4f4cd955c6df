#include "softforce/pipeline/run.h"

#include <fmt/format.h>

#include "pipeline/run_job.h"
#include "softforce/base/input_error.h"

namespace softforce::pipeline {

void RunOptions::Check() const {
  if (first_frame < 0 || end_frame <= first_frame) {
    throw base::InputError("--frames",
                           fmt::format("{}:{} is no range of frames", first_frame, end_frame),
                           "Give A:B with 0 <= A < B: frames A up to but not including B.");
  }
  if (every < 1) {
    throw base::InputError("--every", fmt::format("got {}, must be 1 or more", every),
                           "2 processes every second frame.");
  }
  if (registration_frames < 1) {
    throw base::InputError("--registration-frames", "must be 1 or more");
  }
  if (watch_rig < 0) throw base::InputError("--watch-rig", "must be 0 or more");
  if (overlay_width < 64) throw base::InputError("--overlay-width", "must be 64 px or more");
  if (threads < 0 || threads > kMaxThreads) {
    throw base::InputError("--threads",
                           fmt::format("got {}, must lie between 0 and {}", threads, kMaxThreads),
                           "0 stands for as many as the machine has cores.");
  }
  if (!(duration_s > 0)) throw base::InputError("--duration", "must be greater than 0 s");
  live.Check();
  tracker.Check();
}

RunReport Run(const std::filesystem::path& scene_file, const RunOptions& options) {
  options.Check();
  RunJob job(scene_file, options);
  return job.Finish();
}

}  // namespace softforce::pipeline
