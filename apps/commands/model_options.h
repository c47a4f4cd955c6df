#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "softforce/estimation/force_estimator.h"
#include "softforce/pipeline/mesh_convergence.h"

namespace softforce::apps {

// Options of the model of the body, which `identify` and the runs it is made for share.
// `correct_mesh` takes what ParseMeshAim reads.
void AddModelOptions(CLI::App* app, std::string* correct_mesh,
                     estimation::EstimatorOptions* estimator);

pipeline::MeshAim ParseMeshAim(const std::string& name);  // throws InputError

}  // namespace softforce::apps
