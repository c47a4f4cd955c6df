#include "softforce/fem/static_solver.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/cable_path.h"
#include "fem/cholesky.h"
#include "fem/elements.h"
#include "fem/tangent.h"
#include "softforce/base/input_error.h"

namespace softforce::fem {
namespace {

double LargestMove(const Eigen::Matrix3Xd& du) {
  return du.cols() == 0 ? 0 : std::sqrt(du.colwise().squaredNorm().maxCoeff());
}

const Body& Checked(const Body& body, const std::string& where) {
  body.Check(where);
  return body;
}

}  // namespace

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

struct StaticSolver::State {
  State(Body body_in, const std::string& where, const StaticSolverOptions& options_in)
      : body(std::move(body_in)),
        options(options_in),
        elements(Checked(body, where)),
        assembler(body, elements),
        cholesky(assembler.matrix()) {
    options.Check();
    diagonal = (body.mesh.nodes.rowwise().maxCoeff() - body.mesh.nodes.rowwise().minCoeff()).norm();
    stiffness = elements.ShearModulusTimesVolume();
    weight = body.density * body.gravity * elements.NodalVolumes(body.mesh.num_nodes()).transpose();
    rest_length.resize(num_cables());
    for (int c = 0; c < num_cables(); ++c) {
      rest_length(c) = CableLength(body.cables[c], body.mesh.nodes);
    }
  }

  int num_cables() const { return static_cast<int>(body.cables.size()); }

  // Nodal vectors of the whole body to those of the free nodes and back, column by column.
  Eigen::MatrixXd Gather(const Eigen::MatrixXd& all) const {
    Eigen::MatrixXd free(3 * assembler.num_free_nodes(), all.cols());
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      const int f = assembler.free_index(node);
      if (f >= 0) free.middleRows<3>(3 * f) = all.middleRows<3>(3 * node);
    }
    return free;
  }
  Eigen::MatrixXd Scatter(const Eigen::MatrixXd& free) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * body.mesh.num_nodes(), free.cols());
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      const int f = assembler.free_index(node);
      if (f >= 0) all.middleRows<3>(3 * node) = free.middleRows<3>(3 * f);
    }
    return all;
  }

  bool Factorise(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& tension) {
    assembler.Assemble(elements, u, tension);
    factor_u = u;
    factor_valid = cholesky.Factorise(assembler.matrix());
    return factor_valid;
  }

  // Gradients of the cables' lengths as columns, 3N×cables.
  Eigen::MatrixXd CableGradients(const Eigen::Matrix3Xd& u) const {
    Eigen::MatrixXd G(3 * body.mesh.num_nodes(), num_cables());
    for (int c = 0; c < num_cables(); ++c) {
      Eigen::Matrix3Xd gradient = Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes());
      AddCableGradient(body.cables[c], body.mesh.nodes + u, 1, &gradient);
      G.col(c) = gradient.reshaped();
    }
    return G;
  }
  Eigen::VectorXd CableLengths(const Eigen::Matrix3Xd& u) const {
    Eigen::VectorXd length(num_cables());
    for (int c = 0; c < num_cables(); ++c) {
      length(c) = CableLength(body.cables[c], body.mesh.nodes + u);
    }
    return length;
  }

  struct Step {
    Eigen::Matrix3Xd du;
    Eigen::VectorXd tension;  // after the step
    Eigen::VectorXd penalty;  // N/m, that makes the line search's merit fall along du
    Eigen::VectorXd target;   // m, length that each cable is held at; unused for tension
    double slope;             // of the merit along du; < 0
  };
  // What the cells and the dead loads say at a displacement.
  struct Balance {
    double energy = NAN;          // J, potential energy without the cables
    Eigen::Matrix3Xd unbalanced;  // N, internal forces − dead loads, without the cables
  };

  Balance Evaluate(const LoadCase& load, const Eigen::Matrix3Xd& u) const;
  double Merit(const Balance& balance, const Eigen::Matrix3Xd& u, const Step& step) const;
  double SearchAlong(const LoadCase& load, const Equilibrium& at, const Step& step,
                     Balance* balance) const;
  bool MakeStep(const LoadCase& load, const Equilibrium& at, const Eigen::Matrix3Xd& unbalanced,
                Step* step) const;
  bool Newton(const LoadCase& load, Equilibrium* state, SolveSummary* summary);

  Body body;
  StaticSolverOptions options;
  Elements elements;
  TangentAssembler assembler;
  Cholesky cholesky;
  double diagonal = NAN;   // m
  double stiffness = NAN;  // J, shear modulus times volume: the scale of rounding in the energy
  Eigen::Matrix3Xd weight;
  Eigen::VectorXd rest_length;
  Eigen::Matrix3Xd factor_u;  // where the tangent was factorised
  bool factor_valid = false;
};

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

StaticSolver::StaticSolver(Body body, const std::string& where, const StaticSolverOptions& options)
    : state_(std::make_unique<State>(std::move(body), where, options)) {}
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
