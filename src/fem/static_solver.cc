#include "softforce/fem/static_solver.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "fem/chamber_volume.h"
#include "fem/static_solver_state.h"
#include "softforce/base/input_error.h"

namespace softforce::fem {

void StaticSolverOptions::Check() const {
  if (!(tolerance > 0)) throw base::InputError("tolerance", "must be greater than 0");
  if (max_iterations < 1) throw base::InputError("max_iterations", "must be 1 or more");
  if (!(factorisation_worth >= 0)) {
    throw base::InputError("factorisation_worth", "must be 0 or more");
  }
  if (max_load_halvings < 0) throw base::InputError("max_load_halvings", "must be 0 or more");
}

namespace {

const char* Name(SolveSummary::Status status) {
  switch (status) {
    case SolveSummary::Status::kNotRun:
      return "not run";
    case SolveSummary::Status::kConverged:
      return "converged";
    case SolveSummary::Status::kNotConverged:
      return "not converged";
    case SolveSummary::Status::kUnstable:
      return "unstable";
    case SolveSummary::Status::kInverted:
      return "a cell turns inside out";
  }
  return "";
}

}  // namespace

std::string SolveSummary::BriefReport() const {
  return fmt::format(
      "{} after {} iterations, {} factorisations, {} load steps; last step {:.2e} m{}",
      Name(status), iterations, factorisations, load_steps, last_step,
      ok() ? "" : fmt::format("; reached {:.0f} % of the change of load", 100 * reached_share));
}

std::string SolveSummary::Advice() const {
  switch (status) {
    case Status::kNotRun:
    case Status::kConverged:
      return "";
    case Status::kNotConverged:
      return "Check the units of loads, shortenings and stiffness; spread point forces over a "
             "patch; otherwise allow more iterations or load halvings.";
    case Status::kUnstable:
      return "The body buckles, snaps or bursts beyond that load, or its stiffest material is "
             "many thousand times stiffer than its softest. Check the units of loads and "
             "stiffness; lower the pressure of chambers; drive cables by displacement, which holds "
             "the body where a tension lets it go.";
    case Status::kInverted:
      return fmt::format(
          "The body is crushed around ({:.1f} {:.1f} {:.1f}) mm. Check the units of loads and "
          "stiffness; spread the force over a patch; refine the mesh there; use neo_hookean, "
          "which stiffens as it is crushed.",
          1e3 * inverted_at.x(), 1e3 * inverted_at.y(), 1e3 * inverted_at.z());
  }
  return "";
}

Actuation NoActuation(const Body& body) {
  Actuation none;
  none.cables.resize(body.cables.size());
  none.pressures.resize(body.chambers.size());
  return none;
}

LoadCase OwnWeight(const Body& body) {
  return {Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes()), NoActuation(body)};
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
  rest.load = OwnWeight(state_->body);
  rest.load.weight_share = 0;
  return rest;
}

namespace {

// The load a share of the way from an equilibrium to a goal.
LoadCase Between(const Equilibrium& from, const LoadCase& to, double share) {
  const auto mix = [share](double start, double end) { return (1 - share) * start + share * end; };
  LoadCase load = to;
  load.weight_share = mix(from.load.weight_share, to.weight_share);
  load.forces = (1 - share) * from.load.forces + share * to.forces;
  for (size_t c = 0; c < load.actuation.cables.size(); ++c) {
    const int i = static_cast<int>(c);
    CableCommand& command = load.actuation.cables[c];
    command.value =
        mix(command.input == CableInput::kTension ? from.tension(i) : from.shortening(i),
            command.value);
  }
  for (size_t k = 0; k < load.actuation.pressures.size(); ++k) {
    load.actuation.pressures[k] =
        mix(from.load.actuation.pressures[k], load.actuation.pressures[k]);
  }
  return load;
}

}  // namespace

SolveSummary StaticSolver::Solve(const LoadCase& load, Equilibrium* state) {
  state_->steps_to_load = 0;
  return Reach(load, state_->options.tolerance * state_->diagonal,
               state_->options.max_load_halvings, state);
}

SolveSummary StaticSolver::Approach(const LoadCase& load, double tolerance, bool continued,
                                    Equilibrium* state, std::optional<int> max_load_halvings) {
  if (!continued) state_->steps_to_load = 0;
  return Reach(load, tolerance, max_load_halvings.value_or(state_->options.max_load_halvings),
               state);
}

SolveSummary StaticSolver::Reach(const LoadCase& load, double tolerance, int max_load_halvings,
                                 Equilibrium* state) {
  State& s = *state_;
  assert(load.actuation.cables.size() == s.body.cables.size());
  assert(load.actuation.pressures.size() == s.body.chambers.size());
  assert(load.forces.allFinite());
  SolveSummary summary;
  const Equilibrium from = *state;
  double reached = 0;
  double stride = 1;
  bool just_failed = false;
  const double least = std::ldexp(1.0, -max_load_halvings);
  while (reached < 1) {
    const double next = std::min(1.0, reached + stride);
    Equilibrium trial = *state;
    trial.load = next < 1 ? Between(from, load, next) : load;
    ++summary.load_steps;
    summary.inverted_element = -1;
    if (summary.load_steps > 1) s.steps_to_load = 0;
    summary.status = s.Newton(trial.load, tolerance, &trial, &summary);
    if (summary.ok()) {
      summary.inverted_element = s.elements.InvertedElement(trial.u);
      if (summary.inverted_element >= 0) summary.status = SolveSummary::Status::kInverted;
    }
    if (summary.ok()) {
      trial.shortening = s.rest_length - s.CableLengths(trial.u);
      *state = std::move(trial);
      reached = next;
      if (!just_failed) stride = std::min(2 * stride, 1.0);
      just_failed = false;
    } else {
      just_failed = true;
      s.factor_valid = false;
      stride /= 2;
      if (stride < least) break;
    }
  }
  summary.reached_share = reached;
  if (summary.inverted_element >= 0) {
    summary.inverted_at = s.elements.Centre(summary.inverted_element, s.body.mesh.nodes);
  }
  return summary;
}

bool StaticSolver::LinearStep(const LoadCase& load, Equilibrium* state) {
  State& s = *state_;
  if (!s.StableAt(*state)) return false;
  const State::Balance balance = s.Evaluate(load, state->u);
  if (!std::isfinite(balance.energy)) return false;
  State::Step step;
  s.MakeStep(load, *state, balance.unbalanced, &step);
  if (!step.du.allFinite()) return false;
  state->u += step.du;
  state->tension = step.tension;
  state->shortening = s.rest_length - s.CableLengths(state->u);
  state->load = load;
  return true;
}

Sensitivity StaticSolver::Respond(const Equilibrium& state, const Eigen::MatrixXd& forces,
                                  const Eigen::MatrixXd& shortening, double max_staleness) {
  State& s = *state_;
  Sensitivity sensitivity;
  if (!s.factor_valid || s.inverse.shift() > 0 ||
      LargestMove(state.u - s.factor_u) > max_staleness) {
    if (!s.StableAt(state)) return sensitivity;
  }
  std::vector<int> held;
  for (int c = 0; c < s.num_cables(); ++c) {
    const bool displacement = state.load.actuation.cables[c].input == CableInput::kDisplacement;
    if (displacement && state.tension(c) > 0) held.push_back(c);
  }
  const int k = static_cast<int>(forces.cols());
  const int m = static_cast<int>(held.size());
  Eigen::MatrixXd rhs(3 * s.assembler.num_free_nodes(), k + m);
  rhs.leftCols(k) = s.Gather(forces);
  rhs.rightCols(m) = s.Gather(s.CableGradients(state.u)(Eigen::all, held));
  Eigen::MatrixXd solved = rhs;
  s.inverse.ApplyFactor(&solved);

  sensitivity.ok = true;
  sensitivity.d_tension = Eigen::MatrixXd::Zero(s.num_cables(), k);
  if (m > 0) {  // eq. 4 with the cables' displacement held, or changed as told (eq. 12)
    const Eigen::MatrixXd W_aa = rhs.rightCols(m).transpose() * solved.rightCols(m);
    const Eigen::MatrixXd W_af = rhs.rightCols(m).transpose() * solved.leftCols(k);
    const Eigen::MatrixXd d_tension = W_aa.ldlt().solve(W_af + shortening(held, Eigen::all));
    solved.leftCols(k) -= solved.rightCols(m) * d_tension;
    for (int i = 0; i < m; ++i) sensitivity.d_tension.row(held[i]) = d_tension.row(i);
  }
  sensitivity.du = s.Scatter(solved.leftCols(k));
  return sensitivity;
}

Sensitivity StaticSolver::Solve(const Equilibrium& state, const Eigen::MatrixXd& forces,
                                double max_staleness) {
  return Respond(state, forces, Eigen::MatrixXd::Zero(state_->num_cables(), forces.cols()),
                 max_staleness);
}

Sensitivity StaticSolver::SolveActuation(const Equilibrium& state, double max_staleness) {
  const State& s = *state_;
  const int cables = s.num_cables();
  const int chambers = static_cast<int>(s.body.chambers.size());
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(state.u.size(), cables + chambers);
  Eigen::MatrixXd shortening = Eigen::MatrixXd::Zero(cables, cables + chambers);
  const Eigen::MatrixXd G = s.CableGradients(state.u);
  std::vector<int> pulled;
  for (int c = 0; c < cables; ++c) {
    if (state.load.actuation.cables[c].input == CableInput::kTension) {
      forces.col(c) = -G.col(c);
      pulled.push_back(c);
    } else {
      shortening(c, c) = 1;
    }
  }
  for (int k = 0; k < chambers; ++k) {
    Eigen::Matrix3Xd gradient = Eigen::Matrix3Xd::Zero(3, state.u.cols());
    AddChamberVolumeGradient(s.body.chambers[k], s.body.mesh.nodes + state.u, 1, &gradient);
    forces.col(cables + k) = gradient.reshaped();
  }
  Sensitivity sensitivity = Respond(state, forces, shortening, max_staleness);
  if (sensitivity.ok) {
    for (const int c : pulled) sensitivity.d_tension(c, c) = 1;
  }
  return sensitivity;
}

void StaticSolver::SetMaterials(std::vector<Material> materials) {
  assert(materials.size() == state_->body.materials.size());
  for (const Material& material : materials) material.Check("material");
  state_->SetMaterials(std::move(materials));
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

Eigen::Matrix3Xd StaticSolver::InternalForces(const Eigen::Matrix3Xd& u,
                                              const std::vector<Material>& materials) const {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, u.cols());
  Elements(state_->body.mesh, materials).EnergyAndForces(u, &forces);
  return forces;
}

}  // namespace softforce::fem
