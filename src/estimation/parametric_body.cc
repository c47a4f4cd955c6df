#include "estimation/parametric_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace softforce::estimation {
namespace {

using Kind = Unknown::Kind;

constexpr double kPoissonStep = 1e-6;  // for the difference that stands for a derivative by ν

}  // namespace

ParametricBody::ParametricBody(fem::Body body, const std::vector<KnownState>& states,
                               const std::vector<Unknown>& unknowns,
                               const IdentificationOptions& options)
    : states_(states),
      unknowns_(unknowns),
      options_(options),
      start_materials_(body.materials),
      solver_(std::move(body), "body"),
      theta_(Eigen::VectorXd::Constant(static_cast<Eigen::Index>(unknowns.size()), NAN)),
      now_(states.size(), solver_.AtRest()),
      du_(states.size()) {}

std::vector<int> ParametricBody::RegionsOf(const Unknown& unknown) const {
  if (!unknown.regions.empty()) return unknown.regions;
  std::vector<int> all(start_materials_.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<fem::Material> ParametricBody::Materials(const Eigen::VectorXd& theta) const {
  std::vector<fem::Material> materials = start_materials_;
  for (int p = 0; p < num_unknowns(); ++p) {
    if (unknowns_[p].kind == Kind::kCableOffset) continue;
    for (const int region : RegionsOf(unknowns_[p])) {
      if (unknowns_[p].kind == Kind::kYoungsModulus) {
        materials[region].youngs_modulus *= std::exp(theta(p));
      } else {
        materials[region].poissons_ratio += theta(p);
      }
    }
  }
  return materials;
}

Eigen::VectorXd ParametricBody::CableOffsets(const Eigen::VectorXd& theta) const {
  Eigen::VectorXd offsets =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(solver_.body().cables.size()));
  for (int p = 0; p < num_unknowns(); ++p) {
    if (unknowns_[p].kind == Kind::kCableOffset) offsets(unknowns_[p].cable) += theta(p);
  }
  return offsets;
}

double ParametricBody::Lower(int unknown) const {
  if (unknowns_[unknown].kind != Kind::kPoissonsRatio) {
    return -std::numeric_limits<double>::infinity();
  }
  double lower = -1;
  for (const int region : RegionsOf(unknowns_[unknown])) {
    lower = std::max(lower, -start_materials_[region].poissons_ratio);
  }
  return lower;
}

double ParametricBody::Upper(int unknown) const {
  if (unknowns_[unknown].kind != Kind::kPoissonsRatio) {
    return std::numeric_limits<double>::infinity();
  }
  double upper = 1;
  for (const int region : RegionsOf(unknowns_[unknown])) {
    upper = std::min(upper, options_.max_poissons_ratio - start_materials_[region].poissons_ratio);
  }
  return upper;
}

bool ParametricBody::Solve(int state, const Eigen::VectorXd& theta, fem::Equilibrium* equilibrium) {
  fem::LoadCase load{states_[state].forces, states_[state].actuation};
  const Eigen::VectorXd offsets = CableOffsets(theta);
  for (size_t c = 0; c < load.actuation.cables.size(); ++c) {
    fem::CableCommand& command = load.actuation.cables[c];
    command.value += offsets(static_cast<Eigen::Index>(c));
    if (command.input == fem::CableInput::kTension) command.value = std::max(command.value, 0.0);
  }
  std::vector<fem::Equilibrium> starts;
  if (du_[state].size() > 0) {
    // A small change starts from the linear answer; a large one would stretch what should turn.
    const Eigen::Matrix3Xd du = (du_[state] * (theta - theta_)).reshaped(3, now_[state].u.cols());
    if (du.colwise().norm().maxCoeff() <= options_.estimator.max_staleness) {
      starts.push_back(now_[state]);
      starts.back().u += du;
    }
    starts.push_back(now_[state]);
  } else {
    if (state > 0) starts.push_back(now_[state - 1]);  // frames of a ramp follow each other
    starts.push_back(solver_.AtRest());
  }
  for (fem::Equilibrium& start : starts) {
    const fem::SolveSummary summary = solver_.Solve(load, &start);
    factorisations_ += summary.factorisations;
    if (!summary.ok()) continue;
    *equilibrium = std::move(start);
    return true;
  }
  return false;
}

bool ParametricBody::MoveTo(const Eigen::VectorXd& theta) {
  if (!theta.allFinite()) return false;
  if (theta_ == theta) return true;
  const bool first = !theta_.allFinite();
  for (int p = 0; p < num_unknowns() && !first; ++p) {
    if (unknowns_[p].kind == Kind::kYoungsModulus &&
        std::abs(theta(p) - theta_(p)) > std::log(options_.max_modulus_step)) {
      return false;
    }
  }
  solver_.SetMaterials(Materials(theta));
  std::vector<fem::Equilibrium> reached = now_;
  std::vector<Eigen::MatrixXd> du(states_.size());
  for (int s = 0; s < static_cast<int>(states_.size()); ++s) {
    if (!Solve(s, theta, &reached[s])) return false;
    std::optional<Eigen::MatrixXd> found = Sensitivities(reached[s]);
    if (!found) return false;
    du[s] = std::move(*found);
    if (first) now_[s] = reached[s];  // the next state starts from here
  }
  now_ = std::move(reached);
  du_ = std::move(du);
  theta_ = theta;
  return true;
}

Eigen::VectorXd ParametricBody::ForceDerivative(const Eigen::Matrix3Xd& u,
                                                const Unknown& unknown) const {
  std::vector<fem::Material> up = solver_.body().materials;
  std::vector<fem::Material> down = up;
  double below = kPoissonStep;  // one-sided where Poisson's ratio cannot be less
  for (const int region : RegionsOf(unknown)) {
    if (up[region].poissons_ratio < kPoissonStep) below = 0;
  }
  double step = 1;
  for (const int region : RegionsOf(unknown)) {
    if (unknown.kind == Kind::kYoungsModulus) {
      // The force is linear in E: a difference of any size is its derivative by log E.
      up[region].youngs_modulus *= 1.5;
      down[region].youngs_modulus *= 0.5;
    } else {
      step = kPoissonStep + below;
      up[region].poissons_ratio += kPoissonStep;
      down[region].poissons_ratio -= below;
    }
  }
  const Eigen::Matrix3Xd difference =
      solver_.InternalForces(u, up) - solver_.InternalForces(u, down);
  return difference.reshaped() / step;
}

std::optional<Eigen::MatrixXd> ParametricBody::Sensitivities(const fem::Equilibrium& at) {
  const int n = num_unknowns();
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(at.u.size(), n);
  bool any_cable = false;
  for (int p = 0; p < n; ++p) {
    if (unknowns_[p].kind == Kind::kCableOffset) {
      any_cable = true;
    } else {
      forces.col(p) = -ForceDerivative(at.u, unknowns_[p]);
    }
  }
  const double staleness = options_.estimator.max_staleness;
  fem::Sensitivity answer = solver_.Solve(at, forces, staleness);
  if (!answer.ok) return std::nullopt;
  if (!any_cable) return std::move(answer.du);
  const fem::Sensitivity by_command = solver_.SolveActuation(at, staleness);
  if (!by_command.ok) return std::nullopt;
  for (int p = 0; p < n; ++p) {
    if (unknowns_[p].kind != Kind::kCableOffset) continue;
    answer.du.col(p) = by_command.du.col(unknowns_[p].cable);
  }
  return std::move(answer.du);
}

Eigen::Vector3d ParametricBody::Position(int state, const mesh::NodalWeights& at) const {
  return at.Apply(solver_.body().mesh.nodes) + Displacement(state, at);
}

Eigen::Vector3d ParametricBody::Displacement(int state, const mesh::NodalWeights& at) const {
  return at.Apply(now_[state].u);
}

Eigen::Matrix3Xd ParametricBody::Jacobian(int state, const mesh::NodalWeights& at) const {
  Eigen::Matrix3Xd J = Eigen::Matrix3Xd::Zero(3, num_unknowns());
  for (size_t i = 0; i < at.nodes.size(); ++i) {
    J += at.weights[i] * du_[state].middleRows<3>(3 * at.nodes[i]);
  }
  return J;
}

}  // namespace softforce::estimation
