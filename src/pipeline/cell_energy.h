#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/fem/body.h"
#include "softforce/mesh/refine.h"

namespace softforce::pipeline {

// A coarse mesh's nodal field (3×N) as seen by the nodes of each cell of a refined mesh, one
// 3×(4 or 10) matrix per fine cell.
std::vector<Eigen::Matrix3Xd> OnFineCells(const mesh::TetMesh& coarse, const Eigen::Matrix3Xd& u,
                                          const mesh::Refinement& fine);

// A field of a mesh (3×N), likewise for each of its own cells.
std::vector<Eigen::Matrix3Xd> OnCells(const mesh::TetMesh& mesh, const Eigen::Matrix3Xd& u);

// The work of each cell of the body between two small displacements a and b: ∫ ε(a) : C ε(b) dV, J,
// by the integration rule of the elements.
std::vector<double> CellWork(const fem::Body& body, const std::vector<Eigen::Matrix3Xd>& a,
                             const std::vector<Eigen::Matrix3Xd>& b);

}  // namespace softforce::pipeline
