#pragma once

#include <optional>
#include <vector>

#include "pipeline/frame_file.h"
#include "pipeline/frame_pipeline.h"
#include "pipeline/overlay_video.h"
#include "pipeline/report_log.h"
#include "pipeline/result_tables.h"
#include "pipeline/vtu_series.h"
#include "softforce/pipeline/run.h"

namespace softforce::pipeline {

// The files that a run writes frame by frame. They show up under their names with Commit().
class RunOutputs {
 public:
  // Scene, world and rig must outlive it. Throws InputError if a file cannot be written.
  RunOutputs(const RunOptions& options, const scene::Scene& scene, const World& world,
             const camera::Rig& rig);

  // The steps that write a frame; this must outlive them.
  std::vector<Stage> Stages();

  void Commit();

  const std::optional<ReportLog>& log() const { return log_; }  // nothing: no report was asked for

 private:
  const World& world_;
  ResultTables tables_;
  std::optional<FrameFileWriter> frames_;
  std::optional<OverlayVideo> overlay_;
  double largest_displacement_ = 0;  // m, so far
  std::optional<VtuSeries> series_;
  std::optional<ReportLog> log_;
};

}  // namespace softforce::pipeline
