#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "pipeline/frame_pipeline.h"
#include "pipeline/live_view.h"
#include "pipeline/live_window.h"
#include "pipeline/marker_source.h"
#include "pipeline/mesh_correction.h"
#include "pipeline/run_outputs.h"
#include "pipeline/run_tally.h"
#include "pipeline/tare.h"
#include "softforce/base/progress.h"
#include "softforce/pipeline/run.h"

namespace softforce::pipeline {

// A run in progress: what is known before the first frame, and what the frames add up to.
class RunJob {
 public:
  // Reads all inputs and finds where the rig stands; writes nothing. Options must outlive it.
  RunJob(const std::filesystem::path& scene_file, const RunOptions& options);

  RunReport Finish();

 private:
  std::vector<Stage> Stages(RunOutputs* outputs, base::Progress* progress);
  std::string Note() const;
  bool Next(FrameInWork* frame);
  void ProcessFrames(RunOutputs* outputs);
  void LogSetUp() const;
  void WriteSummaries(const RunOutputs& outputs);

  const RunOptions& options_;
  const scene::Scene scene_;
  const std::unique_ptr<MarkerSource> source_;
  const std::optional<MeshCorrection> correction_;
  const World world_;
  const double index_w_;
  const Standing standing_;
  Tracker tracker_;
  Tare tare_;

  StageClock clock_;
  RunTally tally_;
  // Last: their threads look at the others.
  std::optional<LiveView> live_view_;
  std::optional<LiveWindow> live_window_;
};

}  // namespace softforce::pipeline
