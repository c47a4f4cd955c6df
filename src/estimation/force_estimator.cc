#include "softforce/estimation/force_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/force_estimator_state.h"
#include "softforce/base/input_error.h"

namespace softforce::estimation {
namespace {

// An empty actuation is none, for bodies without actuators.
fem::Actuation Told(const fem::Actuation& actuation, const fem::Body& body) {
  const bool none = actuation.cables.empty() && actuation.pressures.empty();
  return none ? fem::NoActuation(body) : actuation;
}

}  // namespace

void EstimatorOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("estimator option ") + option, rule);
  };
  require(common_model_error >= 0 && common_model_error < 1, "common_model_error",
          "must be at least 0 and below 1");
  require(local_model_error >= 0 && local_model_error < 1, "local_model_error",
          "must be at least 0 and below 1");
  require(force_walk > 0, "force_walk", "must be greater than 0 N");
  require(force_scale > 0, "force_scale", "must be greater than 0 N");
  require(loss_scale > 0, "loss_scale", "must be greater than 0");
  // Below, 1 − probability is 1 in double precision.
  require(rejection_probability >= 1e-15 && rejection_probability < 1, "rejection_probability",
          "must be at least 1e-15 and below 1");
  require(max_rejected_share >= 0 && max_rejected_share < 1, "max_rejected_share",
          "must be at least 0 and below 1");
  require(min_singular_ratio > 0, "min_singular_ratio", "must be greater than 0");
  require(max_iterations >= 1, "max_iterations", "must be 1 or more");
  require(max_factorisations >= 1, "max_factorisations", "must be 1 or more");
  require(tolerance > 0, "tolerance", "must be greater than 0");
  require(max_staleness >= 0, "max_staleness", "must be 0 m or more");
}

const char* Name(EstimationMethod method) {
  switch (method) {
    case EstimationMethod::kConverged:
      return "converged";
    case EstimationMethod::kLinearStep:
      return "linear";
  }
  return "";
}

const char* Name(ForceEstimate::Status status) {
  switch (status) {
    case ForceEstimate::Status::kNotRun:
      return "not_run";
    case ForceEstimate::Status::kOk:
      return "ok";
    case ForceEstimate::Status::kTooFewObservations:
      return "too_few_markers";
    case ForceEstimate::Status::kUnobservable:
      return "unobservable";
    case ForceEstimate::Status::kNotConverged:
      return "not_converged";
    case ForceEstimate::Status::kInconsistent:
      return "inconsistent";
    case ForceEstimate::Status::kInvalidInput:
      return "invalid_input";
  }
  return "";
}

std::string ForceEstimate::BriefReport() const {
  if (!ok()) return fmt::format("{}: {}", Name(status), reason);
  return fmt::format("ok: chi2 {:.1f} of {} degrees of freedom, {} iterations, {} factorisations",
                     chi2, degrees_of_freedom, iterations, factorisations);
}

ForceEstimator::State::State(fem::StaticSolver* solver_in, std::vector<ForceSite> sites_in,
                             const EstimatorOptions& options_in,
                             std::vector<ActuatorUncertainty> actuators_in)
    : solver(solver_in),
      sites(std::move(sites_in)),
      options(options_in),
      actuators(std::move(actuators_in)),
      body(solver, sites, actuators, options.max_staleness) {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  diagonal = (X.rowwise().maxCoeff() - X.rowwise().minCoeff()).norm();
  at_rest = body.pose();
  last_intensity = Eigen::VectorXd::Zero(num_components());
}

int ForceEstimator::State::FirstComponent(int site) const {
  int first = 0;
  for (int s = 0; s < site; ++s) first += static_cast<int>(sites[s].directions.cols());
  return first;
}

std::string ForceEstimator::State::InputProblem(const fem::Actuation& told) const {
  for (const ForceSite& site : sites) {
    if (site.lowest <= site.highest) continue;
    return fmt::format("candidate {}: its force must be at least {} N and at most {} N", site.name,
                       site.lowest, site.highest);
  }
  const fem::Body& b = solver->body();
  for (size_t c = 0; c < told.cables.size(); ++c) {
    const fem::CableCommand& command = told.cables[c];
    const bool pushes = command.input == fem::CableInput::kTension && command.value < 0;
    if (std::isfinite(command.value) && !pushes) continue;
    return fmt::format("cable {} is told {}, which no cable can follow", b.cables[c].name,
                       command.value);
  }
  for (size_t k = 0; k < told.pressures.size(); ++k) {
    if (std::isfinite(told.pressures[k])) continue;
    return fmt::format("chamber {} is told {} Pa", b.chambers[k].name, told.pressures[k]);
  }
  return "";
}

Bounds ForceEstimator::State::ParameterBounds(const fem::Actuation& told) const {
  const int n = num_loads() + 6;
  Bounds bounds{Eigen::VectorXd::Constant(n, -INFINITY), Eigen::VectorXd::Constant(n, INFINITY)};
  for (int s = 0; s < static_cast<int>(sites.size()); ++s) {
    const auto directions = sites[s].directions.cols();
    bounds.lower.segment(FirstComponent(s), directions).setConstant(sites[s].lowest);
    bounds.upper.segment(FirstComponent(s), directions).setConstant(sites[s].highest);
  }
  for (int i = num_components(); i < num_loads(); ++i) {
    const int a = body.uncertain()[i - num_components()];
    const bool cable = a < static_cast<int>(told.cables.size());
    if (cable && told.cables[a].input == fem::CableInput::kTension) {
      bounds.lower(i) = -told.cables[a].value;
    }
  }
  return bounds;
}

Eigen::VectorXd ForceEstimator::State::AllowedLoads(const Bounds& bounds) const {
  return body.pose()
      .loads.cwiseMax(bounds.lower.head(num_loads()))
      .cwiseMin(bounds.upper.head(num_loads()));
}

std::string ForceEstimator::State::NamesIn(const Eigen::VectorXd& combination) const {
  constexpr double kShare = 0.1;  // of a unit vector: smaller parts do not matter
  std::string names;
  const auto add = [&names](const std::string& name) {
    names += (names.empty() ? "" : ", ") + name;
  };
  for (int s = 0; s < static_cast<int>(sites.size()); ++s) {
    const auto part = combination.segment(FirstComponent(s), sites[s].directions.cols());
    if (part.norm() > kShare) add("candidate " + sites[s].name);
  }
  const fem::Body& b = solver->body();
  const int cables = static_cast<int>(b.cables.size());
  for (int i = num_components(); i < num_loads(); ++i) {
    if (std::abs(combination(i)) <= kShare) continue;
    const int a = body.uncertain()[i - num_components()];
    add("actuator " + (a < cables ? b.cables[a].name : b.chambers[a - cables].name));
  }
  return names;
}

ForceEstimator::ForceEstimator(fem::StaticSolver* solver, std::vector<ForceSite> sites,
                               const EstimatorOptions& options,
                               const std::vector<ActuatorUncertainty>& actuators) {
  options.Check();
  std::vector<ActuatorUncertainty> all = actuators;
  all.resize(solver->body().cables.size() + solver->body().chambers.size(), 0);
  state_ = std::make_unique<State>(solver, std::move(sites), options, std::move(all));
}
ForceEstimator::~ForceEstimator() = default;
ForceEstimator::ForceEstimator(ForceEstimator&&) noexcept = default;

int ForceEstimator::num_components() const { return state_->num_components(); }
const std::vector<ForceSite>& ForceEstimator::sites() const { return state_->sites; }
const fem::Equilibrium& ForceEstimator::state() const { return state_->body.state(); }
const Eigen::VectorXd& ForceEstimator::intensity() const { return state_->last_intensity; }

void ForceEstimator::SetRegistrationCovariance(const geometry::Matrix6d& covariance) {
  state_->registration_covariance = covariance;
}

void ForceEstimator::SetBounds(int site, double lowest, double highest) {
  state_->sites[site].lowest = lowest;
  state_->sites[site].highest = highest;
}

ForceEstimate ForceEstimator::State::EstimateFrame(const std::vector<Observation>& observations,
                                                   const fem::Actuation& told) {
  ForceEstimate estimate;
  estimate.reason = InputProblem(told);
  if (!estimate.reason.empty()) {
    estimate.status = ForceEstimate::Status::kInvalidInput;
    estimate.rejected.assign(observations.size(), 0);
    return estimate;
  }
  const int factorised = body.factorisations();
  estimate = options.method == EstimationMethod::kLinearStep ? StepLinearly(observations, told)
                                                             : Converge(observations, told);
  estimate.factorisations = body.factorisations() - factorised;
  if (estimate.ok()) {
    last_intensity = estimate.intensity;
    walk_covariance = estimate.covariance;
    return estimate;
  }
  // A linear step may have left a shape from which there is no next one: begin again.
  const bool stuck = options.method == EstimationMethod::kLinearStep &&
                     estimate.status == ForceEstimate::Status::kNotConverged;
  last_intensity = before_frame.intensity;
  walk_covariance = before_frame.covariance;
  body.Return(stuck ? at_rest : LoadedBody::Pose{before_frame.body, before_frame.loads});
  body.ForgetResponse();
  return estimate;
}

ForceEstimate ForceEstimator::Estimate(const std::vector<Observation>& observations,
                                       const fem::Actuation& actuation) {
  State& s = *state_;
  const fem::Actuation told = Told(actuation, s.solver->body());
  if (s.InputProblem(told).empty()) {
    s.walk_covariance.diagonal().array() += s.options.force_walk * s.options.force_walk;
  }
  s.before_frame = Remember();
  return s.EstimateFrame(observations, told);
}

ForceEstimate ForceEstimator::EstimateAgain(const std::vector<Observation>& observations,
                                            const fem::Actuation& actuation) {
  State& s = *state_;
  s.last_intensity = s.before_frame.intensity;
  s.walk_covariance = s.before_frame.covariance;
  return s.EstimateFrame(observations, Told(actuation, s.solver->body()));
}

ForceEstimator::Memory ForceEstimator::Remember() const {
  const LoadedBody::Pose& pose = state_->body.pose();
  return {pose.state, pose.loads, state_->last_intensity, state_->walk_covariance};
}

void ForceEstimator::Recall(const Memory& memory) {
  State& s = *state_;
  s.body.Return({memory.body, memory.loads});
  s.body.ForgetResponse();
  s.last_intensity = memory.intensity;
  s.walk_covariance = memory.covariance;
}

void ForceEstimator::LimitFactorisations(int most) { state_->options.max_factorisations = most; }

fem::SolveSummary ForceEstimator::StartFrom(const Eigen::VectorXd& intensity,
                                            const fem::Actuation& actuation) {
  State& s = *state_;
  const fem::Actuation told = Told(actuation, s.solver->body());
  fem::SolveSummary summary;
  if (!s.InputProblem(told).empty()) return summary;
  Eigen::VectorXd loads = s.body.pose().loads;
  loads.head(s.num_components()) = intensity;
  return s.MoveTo(loads, told);
}

fem::SolveSummary ForceEstimator::Advance(const fem::Actuation& actuation) {
  State& s = *state_;
  const fem::Actuation told = Told(actuation, s.solver->body());
  fem::SolveSummary summary;
  if (!s.InputProblem(told).empty()) return summary;
  if (s.options.method == EstimationMethod::kConverged) {
    return s.MoveTo(s.body.pose().loads, told);
  }
  // The linear step is made by Estimate alone.
  if (s.body.HasResponse() || s.body.RenewResponse()) {
    summary.status = fem::SolveSummary::Status::kConverged;
  }
  return summary;
}

Eigen::Matrix3Xd ForceEstimator::Compliance(const mesh::NodalWeights& at) const {
  return state_->body.Response(at, LoadedBody::Of::kTangent).leftCols(num_components());
}

Eigen::Vector3d ForceEstimator::Force(const Eigen::VectorXd& intensity, int site) const {
  const Eigen::Matrix3Xd& directions = state_->sites[site].directions;
  return directions * intensity.segment(state_->FirstComponent(site), directions.cols());
}

Eigen::Matrix3d ForceEstimator::ForceCovariance(const Eigen::MatrixXd& covariance, int site) const {
  const Eigen::Matrix3Xd& directions = state_->sites[site].directions;
  const int first = state_->FirstComponent(site);
  const int n = static_cast<int>(directions.cols());
  return directions * covariance.block(first, first, n, n) * directions.transpose();
}

}  // namespace softforce::estimation
