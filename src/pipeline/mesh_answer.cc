#include "pipeline/mesh_answer.h"

#include "pipeline/cell_energy.h"
#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

// Σ_m (weights of marker m) · aim_m / |aim|², for each component.
Eigen::MatrixXd DualForces(const World& world, const Eigen::MatrixXd& aim) {
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(3 * world.mesh().num_nodes(), aim.cols());
  for (size_t m = 0; m < world.markers.size(); ++m) {
    const mesh::NodalWeights& at = world.markers[m].weights;
    for (size_t i = 0; i < at.nodes.size(); ++i) {
      forces.middleRows<3>(3 * at.nodes[i]) +=
          at.weights[i] * aim.middleRows<3>(3 * static_cast<Eigen::Index>(m));
    }
  }
  return forces / aim.squaredNorm();
}

// How a field changed from mesh to mesh, for each fine cell.
std::vector<Eigen::Matrix3Xd> Change(const mesh::TetMesh& coarse, const Eigen::VectorXd& before,
                                     const mesh::TetMesh& fine, const Eigen::VectorXd& after,
                                     const mesh::Refinement& refinement) {
  std::vector<Eigen::Matrix3Xd> cells = OnCells(fine, after.reshaped(3, fine.num_nodes()));
  const std::vector<Eigen::Matrix3Xd> old =
      OnFineCells(coarse, before.reshaped(3, coarse.num_nodes()), refinement);
  for (size_t e = 0; e < cells.size(); ++e) cells[e] -= old[e];
  return cells;
}

}  // namespace

Eigen::MatrixXd UnitForces(const World& world) {
  Eigen::Index components = 0;
  for (const estimation::ForceSite& site : world.sites) components += site.directions.cols();
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(3 * world.mesh().num_nodes(), components);
  Eigen::Index first = 0;
  for (const estimation::ForceSite& site : world.sites) {
    for (size_t i = 0; i < site.at.nodes.size(); ++i) {
      forces.block(3 * site.at.nodes[i], first, 3, site.directions.cols()) =
          site.at.weights[i] * site.directions;
    }
    first += site.directions.cols();
  }
  return forces;
}

Eigen::VectorXd AtMarkers(const World& world, const Eigen::Matrix3Xd& u) {
  Eigen::VectorXd markers(3 * static_cast<Eigen::Index>(world.markers.size()));
  for (size_t m = 0; m < world.markers.size(); ++m) {
    markers.segment<3>(3 * static_cast<Eigen::Index>(m)) = world.markers[m].weights.Apply(u);
  }
  return markers;
}

double BiasOf(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to) {
  return from.cwiseProduct(to).sum() / from.squaredNorm() - 1;
}

MeshAnswer AnswerOf(const World& world, const Eigen::MatrixXd& aim) {
  const int num_nodes = world.mesh().num_nodes();
  fem::Equilibrium state = world.solver->AtRest();
  const fem::SolveSummary settled = world.solver->Solve(
      {Eigen::Matrix3Xd::Zero(3, num_nodes), fem::NoActuation(world.solver->body())}, &state);
  MeshAnswer answer;
  answer.forces = UnitForces(world);
  fem::Sensitivity sensitivity;
  if (settled.ok()) sensitivity = world.solver->Solve(state, answer.forces, 0);
  if (!sensitivity.ok) {
    throw base::InputError("body", "has no stable equilibrium under its own weight",
                           "Check material, gravity and supports.");
  }
  answer.du = std::move(sensitivity.du);
  answer.markers.resize(3 * static_cast<Eigen::Index>(world.markers.size()), answer.du.cols());
  for (Eigen::Index c = 0; c < answer.du.cols(); ++c) {
    answer.markers.col(c) = AtMarkers(world, answer.du.col(c).reshaped(3, num_nodes));
  }
  const Eigen::MatrixXd dual_forces = DualForces(world, aim.size() > 0 ? aim : answer.markers);
  answer.dual = world.solver->Solve(state, dual_forces, 0).du;
  answer.own = answer.forces.cwiseProduct(answer.du).colwise().sum();
  return answer;
}

std::vector<double> ChangeOfCells(const mesh::TetMesh& coarse, const MeshAnswer& coarse_answer,
                                  const fem::Body& fine, const MeshAnswer& fine_answer,
                                  const mesh::Refinement& refinement) {
  std::vector<double> change(refinement.parent.size(), 0);
  for (Eigen::Index c = 0; c < fine_answer.du.cols(); ++c) {
    const std::vector<double> work = CellWork(
        fine, Change(coarse, coarse_answer.du.col(c), fine.mesh, fine_answer.du.col(c), refinement),
        Change(coarse, coarse_answer.dual.col(c), fine.mesh, fine_answer.dual.col(c), refinement));
    for (size_t e = 0; e < work.size(); ++e) change[e] += work[e];
  }
  return change;
}

}  // namespace softforce::pipeline
