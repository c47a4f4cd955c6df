#include "softforce/fem/static_solver.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fem/static_solver_state.h"
#include "softforce/base/input_error.h"

namespace softforce::fem {

void StaticSolverOptions::Check() const {
  if (!(step_tolerance > 0)) throw base::InputError("step_tolerance", "must be greater than 0");
  if (max_iterations < 1) throw base::InputError("max_iterations", "must be 1 or more");
  if (!(stale_contraction >= 0 && stale_contraction < 1)) {
    throw base::InputError("stale_contraction", "must be at least 0 and below 1");
  }
  if (max_load_halvings < 0) throw base::InputError("max_load_halvings", "must be 0 or more");
}

std::string SolveSummary::BriefReport() const {
  return fmt::format(
      "{} after {} iterations, {} factorisations, {} load steps; last step {:.2e} m{}",
      ok() ? "converged" : "not converged", iterations, factorisations, load_steps, last_step,
      ok() ? "" : fmt::format("; reached {:.0f} % of the load", 100 * reached_share));
}

StaticSolver::StaticSolver(Body body, const std::string& where,
                           const StaticSolverOptions& options) {
  options.Check();
  body.Check(where);
  state_ = std::make_unique<State>(std::move(body), options);
}
StaticSolver::~StaticSolver() = default;
StaticSolver::StaticSolver(StaticSolver&&) noexcept = default;

const Body& StaticSolver::body() const { return state_->body; }

Equilibrium StaticSolver::AtRest() const {
  const int n = state_->body.mesh.num_nodes();
  const int cables = state_->num_cables();
  Equilibrium rest;
  rest.u = Eigen::Matrix3Xd::Zero(3, n);
  rest.tension = rest.shortening = Eigen::VectorXd::Zero(cables);
  rest.load.forces = rest.u;
  rest.load.commands.resize(cables);
  return rest;
}

namespace {

// The load a share of the way from an equilibrium to a goal.
LoadCase Between(const Equilibrium& from, const LoadCase& to, double share) {
  LoadCase load = to;
  load.forces = (1 - share) * from.load.forces + share * to.forces;
  for (size_t c = 0; c < load.commands.size(); ++c) {
    const int i = static_cast<int>(c);
    const double start =
        to.commands[c].input == CableInput::kTension ? from.tension(i) : from.shortening(i);
    load.commands[c].value = (1 - share) * start + share * to.commands[c].value;
  }
  return load;
}

}  // namespace

SolveSummary StaticSolver::Solve(const LoadCase& load, Equilibrium* state) {
  SolveSummary summary;
  const Equilibrium from = *state;
  double reached = 0;
  double stride = 1;
  const double least = std::ldexp(1.0, -state_->options.max_load_halvings);
  while (reached < 1) {
    const double next = std::min(1.0, reached + stride);
    Equilibrium trial = *state;
    const LoadCase target = next < 1 ? Between(from, load, next) : load;
    ++summary.load_steps;
    if (state_->Newton(target, &trial, &summary)) {
      trial.load = target;
      trial.shortening = state_->rest_length - state_->CableLengths(trial.u);
      *state = std::move(trial);
      reached = next;
      stride = std::min(2 * stride, 1.0);
    } else {
      state_->factor_valid = false;
      stride /= 2;
      if (stride < least) break;
    }
  }
  summary.reached_share = reached;
  summary.status =
      reached >= 1 ? SolveSummary::Status::kConverged : SolveSummary::Status::kNotConverged;
  return summary;
}

Sensitivity StaticSolver::Solve(const Equilibrium& state, const Eigen::MatrixXd& forces,
                                double max_staleness) {
  State& s = *state_;
  Sensitivity sensitivity;
  if (!s.factor_valid || LargestMove(state.u - s.factor_u) > max_staleness) {
    if (!s.Factorise(state.u, state.tension)) return sensitivity;
  }
  std::vector<int> held;
  for (int c = 0; c < s.num_cables(); ++c) {
    const bool displacement = state.load.commands[c].input == CableInput::kDisplacement;
    if (displacement && state.tension(c) > 0) held.push_back(c);
  }
  const int k = static_cast<int>(forces.cols());
  const int m = static_cast<int>(held.size());
  Eigen::MatrixXd rhs(3 * s.assembler.num_free_nodes(), k + m);
  rhs.leftCols(k) = s.Gather(forces);
  rhs.rightCols(m) = s.Gather(s.CableGradients(state.u)(Eigen::all, held));
  Eigen::MatrixXd solved = rhs;
  s.cholesky.SolveInPlace(&solved);

  sensitivity.ok = true;
  sensitivity.d_tension = Eigen::MatrixXd::Zero(s.num_cables(), k);
  if (m > 0) {  // W_aa⁻¹ W_af, eq. 4 with the cables' displacement held
    const Eigen::MatrixXd W_aa = rhs.rightCols(m).transpose() * solved.rightCols(m);
    const Eigen::MatrixXd W_af = rhs.rightCols(m).transpose() * solved.leftCols(k);
    const Eigen::MatrixXd d_tension = W_aa.ldlt().solve(W_af);
    solved.leftCols(k) -= solved.rightCols(m) * d_tension;
    for (int i = 0; i < m; ++i) sensitivity.d_tension.row(held[i]) = d_tension.row(i);
  }
  sensitivity.du = s.Scatter(solved.leftCols(k));
  return sensitivity;
}

double StaticSolver::ElasticEnergy(const Equilibrium& state) const {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, state.u.cols());
  return state_->elements.EnergyAndForces(state.u, &forces);
}

Eigen::Matrix3Xd StaticSolver::InternalForces(const Eigen::Matrix3Xd& u) const {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, u.cols());
  state_->elements.EnergyAndForces(u, &forces);
  return forces;
}

}  // namespace softforce::fem
