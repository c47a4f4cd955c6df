// Newton's method for the static equilibrium: see the class comment of StaticSolver.
#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "fem/static_solver_state.h"

namespace softforce::fem {

StaticSolver::State::Balance StaticSolver::State::Evaluate(const LoadCase& load,
                                                           const Eigen::Matrix3Xd& u) const {
  const Eigen::Matrix3Xd dead = load.forces + weight;
  Balance balance;
  balance.unbalanced = -dead;
  balance.energy = elements.EnergyAndForces(u, &balance.unbalanced) - dead.cwiseProduct(u).sum();
  return balance;
}

// Potential energy, and for the cables held at a length the augmented Lagrangian
// Σ t (ℓ − target) + penalty/2 (ℓ − target)².
double StaticSolver::State::Merit(const Balance& balance, const Eigen::Matrix3Xd& u,
                                  const Step& step) const {
  const Eigen::VectorXd gap = CableLengths(u) - step.target;
  return balance.energy + step.tension.dot(gap) + 0.5 * step.penalty.dot(gap.cwiseAbs2());
}

// K du = −unbalanced − Σ t G with G·du = −gap for each cable held at a length; a cable whose
// tension would come out negative is slack instead.
bool StaticSolver::State::MakeStep(const LoadCase& load, const Equilibrium& at,
                                   const Eigen::Matrix3Xd& unbalanced, Step* step) const {
  const int n = num_cables();
  const Eigen::MatrixXd G = CableGradients(at.u);
  const Eigen::VectorXd length = CableLengths(at.u);
  step->tension = Eigen::VectorXd::Zero(n);
  step->penalty = Eigen::VectorXd::Zero(n);
  step->target = rest_length;
  std::vector<int> held;
  for (int c = 0; c < n; ++c) {
    if (load.commands[c].input == CableInput::kTension) {
      step->tension(c) = load.commands[c].value;
    } else {
      step->target(c) = rest_length(c) - load.commands[c].value;
      const bool slack = at.tension(c) <= 0 && length(c) < step->target(c) - 1e-12 * diagonal;
      if (!slack) held.push_back(c);
    }
  }

  Eigen::MatrixXd rhs(3 * assembler.num_free_nodes(), 1 + held.size());
  rhs.col(0) = -Gather(unbalanced.reshaped() + G * step->tension);
  rhs.rightCols(held.size()) = Gather(G(Eigen::all, held));
  Eigen::MatrixXd solved = rhs;
  cholesky.SolveInPlace(&solved);

  // Tensions of the held cables; drop the most pushing one until none pushes.
  Eigen::VectorXd du = solved.col(0);
  std::vector<int> used(held.size());
  for (size_t i = 0; i < used.size(); ++i) used[i] = static_cast<int>(i);
  while (!used.empty()) {
    const int m = static_cast<int>(used.size());
    Eigen::MatrixXd compliance(m, m);
    Eigen::VectorXd wanted(m);
    for (int i = 0; i < m; ++i) {
      const int c = held[used[i]];
      wanted(i) = rhs.col(1 + used[i]).dot(solved.col(0)) + length(c) - step->target(c);
      for (int j = 0; j < m; ++j) {
        compliance(i, j) = rhs.col(1 + used[i]).dot(solved.col(1 + used[j]));
      }
    }
    const Eigen::VectorXd tension = compliance.ldlt().solve(wanted);
    int lowest = 0;
    if (tension.minCoeff(&lowest) < 0) {
      used.erase(used.begin() + lowest);
      continue;
    }
    for (int i = 0; i < m; ++i) {
      step->tension(held[used[i]]) = tension(i);
      step->penalty(held[used[i]]) = 1 / compliance(i, i);
      du -= tension(i) * solved.col(1 + used[i]);
    }
    break;
  }
  step->du = Scatter(du).reshaped(3, body.mesh.num_nodes());

  const Eigen::VectorXd residual = unbalanced.reshaped() + G * step->tension;
  step->slope = residual.dot(step->du.reshaped());
  for (int c = 0; c < n; ++c) {
    if (step->penalty(c) == 0) continue;
    step->slope +=
        step->penalty(c) * (length(c) - step->target(c)) * G.col(c).dot(step->du.reshaped());
  }
  return std::isfinite(step->slope) && step->du.allFinite();
}

// The share of the step at which the merit has fallen enough: 1, 1/2, … , or 0 if it never does.
// Close to the solution the merit's change drowns in rounding, and the whole step is right.
// `balance` is that of the start, and becomes that of the place found.
double StaticSolver::State::SearchAlong(const LoadCase& load, const Equilibrium& at,
                                        const Step& step, Balance* balance) const {
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

bool StaticSolver::State::Newton(const LoadCase& load, Equilibrium* state, SolveSummary* summary) {
  const double tolerance = options.step_tolerance * diagonal;
  double previous_move = std::numeric_limits<double>::infinity();
  Balance balance = Evaluate(load, state->u);
  if (!std::isfinite(balance.energy)) return false;  // a cell is inside out
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const bool fresh = !factor_valid;
    if (fresh) {
      if (!Factorise(state->u, state->tension)) return false;
      ++summary->factorisations;
    }
    Step step;
    if (!MakeStep(load, *state, balance.unbalanced, &step)) return false;
    ++summary->iterations;

    const double share = SearchAlong(load, *state, step, &balance);
    if (share == 0) {
      if (fresh) return false;
      factor_valid = false;  // an old tangent may have pointed the wrong way
      continue;
    }
    const double move = share * LargestMove(step.du);
    state->u += share * step.du;
    state->tension += share * (step.tension - state->tension);
    summary->last_step = move;
    if (share == 1 && move <= tolerance) return true;
    if (share < 1 || move > options.stale_contraction * previous_move) factor_valid = false;
    previous_move = move;
  }
  return false;
}

}  // namespace softforce::fem
