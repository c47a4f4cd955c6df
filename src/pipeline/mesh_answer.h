#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/mesh/refine.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// How a meshed body answers to a newton on each component of its candidates: at rest (under its
// own weight), cables slack.
struct MeshAnswer {
  Eigen::MatrixXd forces;   // 3N×k, per newton
  Eigen::MatrixXd du;       // 3N×k, m/N
  Eigen::MatrixXd markers;  // 3M×k, m/N; displacements of the markers
  Eigen::VectorXd own;      // k, m/N; of each candidate's place along its own component
  // 3N×k: displacements under the weights that the markers have in the bias, as if they were
  // forces: Σ_c forces_cᵀ · dual_c = 〈aim, markers〉 / |aim|².
  Eigen::MatrixXd dual;
};

// A newton on each component of the candidates, 3N×k.
Eigen::MatrixXd UnitForces(const World& world);

// `aim`: the given mesh's `markers`, against which BiasOf measures; empty if this is it. Throws
// InputError if the body has no stable equilibrium under its weight.
MeshAnswer AnswerOf(const World& world, const Eigen::MatrixXd& aim = {});

// Displacements of the markers, stacked, in a nodal field (3×N).
Eigen::VectorXd AtMarkers(const World& world, const Eigen::Matrix3Xd& u);

// The factor that makes `from` fit `to` best in the sense of least squares, less 1.
double BiasOf(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to);

// What a refinement changed in each fine cell. The sum over the cells is the change of the bias:
// with a(·,·) the elastic work, 〈aim, ΔW〉/|aim|² = Σ_c a(Δu_c, Δz_c), z being the dual solution,
// since the finite element errors Δu and Δz are orthogonal to the coarse mesh's fields.
std::vector<double> ChangeOfCells(const mesh::TetMesh& coarse, const MeshAnswer& coarse_answer,
                                  const fem::Body& fine, const MeshAnswer& fine_answer,
                                  const mesh::Refinement& refinement);

}  // namespace softforce::pipeline
