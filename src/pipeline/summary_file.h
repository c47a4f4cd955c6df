#pragma once

#include <filesystem>

#include "pipeline/mesh_correction.h"
#include "pipeline/stage_clock.h"
#include "softforce/pipeline/run.h"
#include "softforce/vision/rig_pose.h"

namespace softforce::pipeline {

// What summary.json tells besides the tables.
struct RunFacts {
  const scene::Scene& scene;
  const RunOptions& options;
  const RunReport& report;
  const World& world;
  const std::optional<MeshCorrection>& correction;
  std::optional<vision::RigPose> registration;
  std::map<std::string, int> frame_statuses, marker_statuses;
  double index_w = NAN;              // I_w = ‖W_ef⁺‖₁ of the body at rest, N/m
  std::vector<double> reduced_chi2;  // of each frame: whitened squared misfit per degree of freedom
  std::vector<StageClock::Percentiles> stages;
  std::vector<std::filesystem::path> inputs;
};

void WriteSummary(const RunFacts& facts, const std::filesystem::path& file);

}  // namespace softforce::pipeline
