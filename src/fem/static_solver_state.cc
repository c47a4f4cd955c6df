#include "fem/static_solver_state.h"

#include "fem/chamber_volume.h"

namespace softforce::fem {

StaticSolver::State::State(Body body_in, const StaticSolverOptions& options_in)
    : body(std::move(body_in)),
      options(options_in),
      elements(body),
      assembler(body, elements),
      inverse(assembler.matrix()) {
  diagonal = (body.mesh.nodes.rowwise().maxCoeff() - body.mesh.nodes.rowwise().minCoeff()).norm();
  stiffness = elements.ShearModulusTimesVolume();
  weight = body.density * body.gravity * elements.NodalVolumes(body.mesh.num_nodes()).transpose();
  rest_length = CableLengths(Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes()));
}

void StaticSolver::State::SetMaterials(std::vector<Material> materials) {
  body.materials = std::move(materials);
  elements = Elements(body);
  stiffness = elements.ShearModulusTimesVolume();
  elastic = Elastic();
  factor_valid = false;
}

Eigen::MatrixXd StaticSolver::State::Gather(const Eigen::MatrixXd& all) const {
  Eigen::MatrixXd free(3 * assembler.num_free_nodes(), all.cols());
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    const int f = assembler.free_index(node);
    if (f >= 0) free.middleRows<3>(3 * f) = all.middleRows<3>(3 * node);
  }
  for (const int row : assembler.held()) free.row(row).setZero();
  return free;
}

Eigen::MatrixXd StaticSolver::State::Scatter(const Eigen::MatrixXd& free) const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * body.mesh.num_nodes(), free.cols());
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    const int f = assembler.free_index(node);
    if (f >= 0) all.middleRows<3>(3 * node) = free.middleRows<3>(3 * f);
  }
  return all;
}

Eigen::MatrixXd StaticSolver::State::CableGradients(const Eigen::Matrix3Xd& u) const {
  Eigen::MatrixXd G(3 * body.mesh.num_nodes(), num_cables());
  for (int c = 0; c < num_cables(); ++c) {
    Eigen::Matrix3Xd gradient = Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes());
    AddCableGradient(body.cables[c], body.mesh.nodes + u, 1, &gradient);
    G.col(c) = gradient.reshaped();
  }
  return G;
}

Eigen::VectorXd StaticSolver::State::CableLengths(const Eigen::Matrix3Xd& u) const {
  Eigen::VectorXd length(num_cables());
  for (int c = 0; c < num_cables(); ++c) {
    length(c) = CableLength(body.cables[c], body.mesh.nodes + u);
  }
  return length;
}

bool StaticSolver::State::Factorise(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& tension,
                                    const std::vector<double>& pressures) {
  assembler.Assemble(elements, u, tension, pressures);
  factor_u = u;
  wasted = 0;
  factor_valid = inverse.Factorise(assembler.matrix());
  if (factor_valid && num_cables() > 0) {
    cable_columns = Gather(CableGradients(u));
    inverse.ApplyFactor(&cable_columns);
  }
  return factor_valid;
}

bool StaticSolver::State::StableAt(const Equilibrium& state) {
  const bool stable =
      Factorise(state.u, state.tension, state.load.actuation.pressures) && inverse.shift() == 0;
  factor_valid = stable;  // a shifted one is good for a step from where it was made, no more
  return stable;
}

StaticSolver::State::Balance StaticSolver::State::Evaluate(const LoadCase& load,
                                                           const Eigen::Matrix3Xd& u) {
  if (elastic.u.cols() != u.cols() || elastic.u != u) {
    elastic.forces.setZero(3, u.cols());
    elastic.energy = elements.EnergyAndForces(u, &elastic.forces);
    elastic.u = u;
  }
  const Eigen::Matrix3Xd dead = load.forces + load.weight_share * weight;
  Balance balance{elastic.energy - dead.cwiseProduct(u).sum(), elastic.forces - dead};
  for (size_t c = 0; c < body.chambers.size(); ++c) {
    const double pressure = load.actuation.pressures[c];
    if (pressure == 0) continue;
    const Eigen::Matrix3Xd x = body.mesh.nodes + u;
    balance.energy -= pressure * ChamberVolume(body.chambers[c], x);
    AddChamberVolumeGradient(body.chambers[c], x, -pressure, &balance.unbalanced);
  }
  return balance;
}

}  // namespace softforce::fem
