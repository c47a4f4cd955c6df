#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/frame_feed.h"
#include "pipeline/frame_pipeline.h"
#include "pipeline/mesh_correction.h"
#include "pipeline/parallel_detector.h"
#include "pipeline/registration.h"
#include "pipeline/rig_watch.h"
#include "pipeline/run_outputs.h"
#include "pipeline/run_tally.h"
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
  Standing PlaceRig();
  std::vector<Stage> Stages(RunOutputs* outputs, base::Progress* progress);
  void Detect(FrameInWork* frame);
  void Estimate(FrameInWork* frame);
  std::string Note() const;
  void ProcessFrames(RunOutputs* outputs);
  void LogSetUp() const;
  void WriteSummaryFile();

  const RunOptions& options_;
  const scene::Scene scene_;
  const camera::Rig rig_;
  FrameFeed feed_;
  const std::optional<MeshCorrection> correction_;
  const World world_;
  const double index_w_;
  ParallelDetector detector_;
  const Standing standing_;
  Tracker tracker_;
  RigWatch watch_;

  StageClock clock_;
  RunTally tally_;
};

}  // namespace softforce::pipeline
