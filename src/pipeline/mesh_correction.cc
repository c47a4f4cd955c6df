#include "pipeline/mesh_correction.h"

#include <algorithm>
#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

// No correction is so good that the model had no error at all.
constexpr double kLeastModelError = 0.1;  // of what is allowed without correction

}  // namespace

const char* Name(MeshAim aim) {
  switch (aim) {
    case MeshAim::kGiven:
      return "none";
    case MeshAim::kRefined:
      return "refined";
    case MeshAim::kConverged:
      return "converged";
  }
  return "";
}

std::optional<MeshCorrection> CorrectMesh(const scene::Scene& scene, MeshAim aim,
                                          bool show_progress) {
  if (aim == MeshAim::kGiven) return std::nullopt;
  if (aim == MeshAim::kConverged && scene.mesh.order == 1) {
    throw base::InputError(
        scene.file.string() + ": body: mesh: order",
        "is 1: 4-node cells lock, and how far they are from the limit cannot be told",
        "Set 'order: 2'.");
  }
  MeshConvergenceOptions options;
  options.working_deflection = -1;
  options.show_progress = show_progress;
  // The first level is used. Further ones only tell where the limit is.
  if (aim == MeshAim::kRefined) options.max_levels = 1;
  const MeshConvergence found = AssessMesh(scene, BuildWorld(scene), options);

  MeshCorrection correction;
  correction.scene = scene;
  correction.mesh = found.local.front().mesh;
  correction.given_cells = found.cells;
  correction.bias = found.overall;
  correction.left = found.local.front().remaining;
  const double left =
      aim == MeshAim::kRefined ? correction.left.refined : correction.left.converged;
  correction.modulus_factor = 1 / (1 + left);
  for (auto& [region, material] : correction.scene.materials) {
    material.youngs_modulus *= correction.modulus_factor;
  }
  const double uncorrected = aim == MeshAim::kRefined
                                 ? found.overall.converged - found.overall.refined
                                 : found.overall.uncertain;
  const double share = std::abs(uncorrected / found.overall.converged);
  correction.model_error_factor =
      std::isfinite(share) ? std::clamp(share, kLeastModelError, 1.0) : 1;
  return correction;
}

World BuildWorld(const scene::Scene& scene, const std::optional<MeshCorrection>& correction) {
  return correction ? BuildWorld(correction->scene, correction->mesh) : BuildWorld(scene);
}

TrackerOptions Corrected(TrackerOptions options, const std::optional<MeshCorrection>& correction) {
  if (!correction) return options;
  options.estimator.common_model_error *= correction->model_error_factor;
  options.estimator.local_model_error *= correction->model_error_factor;
  return options;
}

}  // namespace softforce::pipeline
