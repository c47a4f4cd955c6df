#pragma once

#include <filesystem>

#include "pipeline/input_files.h"
#include "pipeline/mesh_correction.h"
#include "pipeline/rig_watch.h"
#include "pipeline/run_tally.h"
#include "softforce/pipeline/run.h"

namespace softforce::pipeline {

// What summary.json tells besides the tables.
struct RunFacts {
  const scene::Scene& scene;
  const RunOptions& options;
  const RunTally& tally;
  const World& world;
  const std::optional<MeshCorrection>& correction;
  const Standing& standing;  // of the rig at the beginning
  double index_w = NAN;      // I_w = ‖W_ef⁺‖₁ of the body at rest, N/m
  std::vector<InputFile> inputs;
  std::vector<RigEvent> rig_events;
};

void WriteSummary(const RunFacts& facts, const std::filesystem::path& file);

}  // namespace softforce::pipeline
