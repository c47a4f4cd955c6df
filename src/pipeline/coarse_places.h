#pragma once

#include "softforce/pipeline/mesh_convergence.h"

namespace softforce::pipeline {

// The places where the cells lie that have most of the bias (`share` of each cell, sum 1), by
// cells that hang together. `left_after_halving`: of the error, when the size is halved.
std::vector<CoarsePlace> CoarsePlaces(const mesh::TetMesh& mesh, const Eigen::VectorXd& share,
                                      double left_after_halving);

}  // namespace softforce::pipeline
