#pragma once

#include "pipeline/mesh_answer.h"
#include "softforce/pipeline/mesh_convergence.h"

namespace softforce::pipeline {

// Compares the given mesh with a local refinement of it under large loads on all candidates at
// once. What the local mesh leaves out is added in the proportion found at rest, from the answers
// of the markers (3M×k, m/N) of the local, the once refined and the converged mesh.
WorkingMeshBias CompareAtWork(const World& given, const MeshAnswer& given_answer,
                              const World& local, const Eigen::MatrixXd& local_markers,
                              const Eigen::MatrixXd& refined, const Eigen::MatrixXd& converged,
                              const MeshConvergenceOptions& options);

}  // namespace softforce::pipeline
