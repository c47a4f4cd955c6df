// Newton's method for the static equilibrium: see the class comment of StaticSolver.
#include <Eigen/LU>
#include <cmath>

#include "fem/progress.h"
#include "fem/static_solver_state.h"

namespace softforce::fem {
namespace {

constexpr int kFreshSteps = 2;          // that a small change of load takes with a fresh factor
constexpr int kMostUnstableSteps = 20;  // in a row, with a tangent that had to be shifted

}  // namespace

// Why an iteration got no further.
SolveSummary::Status StaticSolver::State::StalledStatus() const {
  return inverse.shift() > 0 ? SolveSummary::Status::kUnstable
                             : SolveSummary::Status::kNotConverged;
}

// Potential energy, and for the cables held at a length the augmented Lagrangian
// Σ t (ℓ − target) + penalty/2 (ℓ − target)².
double StaticSolver::State::Merit(const Balance& balance, const Eigen::Matrix3Xd& u,
                                  const Step& step) const {
  const Eigen::VectorXd gap = CableLengths(u) - step.target;
  return balance.energy + step.tension.dot(gap) + 0.5 * step.penalty.dot(gap.cwiseAbs2());
}

// The cables commanded by displacement, unless slack; sets what is known of the step beforehand.
std::vector<int> StaticSolver::State::CablesToHold(const LoadCase& load, const Equilibrium& at,
                                                   const Eigen::VectorXd& length,
                                                   Step* step) const {
  const int n = num_cables();
  step->tension = Eigen::VectorXd::Zero(n);
  step->penalty = Eigen::VectorXd::Zero(n);
  step->target = rest_length;
  std::vector<int> held;
  for (int c = 0; c < n; ++c) {
    const CableCommand& command = load.actuation.cables[c];
    if (command.input == CableInput::kTension) {
      step->tension(c) = command.value;
      continue;
    }
    step->target(c) = rest_length(c) - command.value;
    const bool slack = at.tension(c) <= 0 && length(c) < step->target(c) - 1e-12 * diagonal;
    if (slack) continue;
    held.push_back(c);
    step->tension(c) = std::max(0.0, at.tension(c));
  }
  return held;
}

// K du = −residual − Σ dt G with G·du = −gap for each cable held at a length, the residual that
// under the tensions at hand and dt their change; a cable whose tension would come out negative is
// slack instead. The cables' own columns Z = K⁻¹G are those of the last factorisation: G·du = −gap
// holds all the same, and what du is off by the next step corrects.
bool StaticSolver::State::MakeStep(const LoadCase& load, const Equilibrium& at,
                                   const Eigen::Matrix3Xd& unbalanced, Step* step) const {
  const Eigen::VectorXd length = CableLengths(at.u);
  std::vector<int> held = CablesToHold(load, at, length, step);
  const Eigen::MatrixXd G = Gather(CableGradients(at.u));
  const Eigen::VectorXd free_unbalanced = Gather(unbalanced.reshaped());
  Eigen::VectorXd& du = step->free_du;
  du = inverse.Apply(-(free_unbalanced + G * step->tension));

  // Drop the most pushing cable until none pushes.
  while (!held.empty()) {
    const Eigen::MatrixXd G_held = G(Eigen::all, held);
    const Eigen::MatrixXd Z_held = cable_columns(Eigen::all, held);
    const Eigen::MatrixXd compliance = G_held.transpose() * Z_held;
    const Eigen::VectorXd gap = (length - step->target)(held);
    const Eigen::VectorXd change = compliance.partialPivLu().solve(G_held.transpose() * du + gap);
    int lowest = 0;
    if ((step->tension(held) + change).minCoeff(&lowest) < 0) {
      const int slack = held[lowest];
      du += cable_columns.col(slack) * step->tension(slack);
      step->tension(slack) = 0;
      held.erase(held.begin() + lowest);
      continue;
    }
    step->tension(held) += change;
    step->penalty(held) = compliance.diagonal().cwiseInverse();
    du -= Z_held * change;
    break;
  }
  step->du = Scatter(du).reshaped(3, body.mesh.num_nodes());
  step->free_residual = free_unbalanced + G * step->tension;
  step->slope = step->free_residual.dot(du) +
                step->penalty.cwiseProduct(length - step->target).dot(G.transpose() * du);
  return step->slope <= 0 && du.allFinite();
}

// The share of the step at which the merit has fallen enough: 1, 1/2, … , or 0 if it never does.
// Close to the solution the merit's change drowns in rounding, and the whole step is right.
// `balance` is that of the start, and becomes that of the place found.
double StaticSolver::State::SearchAlong(const LoadCase& load, const Equilibrium& at,
                                        const Step& step, Balance* balance) {
  const double start = Merit(*balance, at.u, step);
  const double rounding = 1e-10 * std::abs(start) + 1e-13 * stiffness;
  for (double share = 1; share > 1e-4; share /= 2) {
    const Eigen::Matrix3Xd u = at.u + share * step.du;
    Balance there = Evaluate(load, u);
    const bool fell = Merit(there, u, step) <= start + 1e-4 * share * step.slope;
    if (fell || (-step.slope <= rounding && std::isfinite(there.energy))) {
      *balance = std::move(there);
      return share;
    }
  }
  return 0;
}

// Whether no cable without tension is longer than its command lets it be.
bool StaticSolver::State::SlackCablesFit(const LoadCase& load, const Equilibrium& state,
                                         double tolerance) const {
  const Eigen::VectorXd shortening = rest_length - CableLengths(state.u);
  for (int c = 0; c < num_cables(); ++c) {
    const CableCommand& command = load.actuation.cables[c];
    if (command.input != CableInput::kDisplacement || state.tension(c) > 0) continue;
    if (shortening(c) < command.value - tolerance) return false;
  }
  return true;
}

SolveSummary::Status StaticSolver::State::Newton(const LoadCase& load, double tolerance,
                                                 Equilibrium* state, SolveSummary* summary) {
  Balance balance = Evaluate(load, state->u);
  if (!std::isfinite(balance.energy)) return SolveSummary::Status::kNotConverged;
  Progress progress;
  int unstable_steps = 0;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const bool fresh = !factor_valid;
    if (fresh) {
      if (unstable_steps >= kMostUnstableSteps) return SolveSummary::Status::kUnstable;
      ++summary->factorisations;
      if (!Factorise(state->u, state->tension, load.actuation.pressures)) {
        return SolveSummary::Status::kUnstable;
      }
      unstable_steps = inverse.shift() > 0 ? unstable_steps + 1 : 0;
    }
    ++summary->iterations;
    Step step;
    const bool falls = MakeStep(load, *state, balance.unbalanced, &step);
    const double share = falls ? SearchAlong(load, *state, step, &balance) : 0;
    if (share == 0) {
      if (fresh) return StalledStatus();
      factor_valid = false;  // an old tangent may have pointed the wrong way
      continue;
    }

    const double move = share * LargestMove(step.du);
    state->u += share * step.du;
    state->tension += share * (step.tension - state->tension);
    const Eigen::MatrixXd residual =
        Gather(balance.unbalanced.reshaped() + CableGradients(state->u) * step.tension);
    inverse.Learn(share * step.free_du, residual - step.free_residual);

    progress.Add(move, -step.slope);
    summary->last_step = move;
    // A single small step is believed if its factor was made for it, or if it took away most of
    // what the residual had along it and the steps before do not speak against it: an old factor
    // may take a soft body for a stiff one.
    const double left = std::abs(step.free_du.dot(residual.col(0)));
    const bool telling = left <= 0.1 * std::abs(step.free_du.dot(step.free_residual)) &&
                         (progress.steps() < 3 || progress.remaining() <= 2 * tolerance);
    const bool small = move <= tolerance && (fresh || move <= 1e-3 * tolerance || telling);
    const bool settled = small || 2 * progress.remaining() <= tolerance;
    if (share == 1 && settled && SlackCablesFit(load, *state, tolerance)) {
      return inverse.shift() > 0 ? SolveSummary::Status::kUnstable
                                 : SolveSummary::Status::kConverged;
    }
    if (++steps_to_load > kFreshSteps) ++wasted;
    const double worth = options.factorisation_worth;
    factor_valid = share == 1 && inverse.shift() == 0 && worth > 0 &&
                   wasted + progress.steps_left(tolerance) - kFreshSteps <= worth;
  }
  return StalledStatus();
}

}  // namespace softforce::fem
