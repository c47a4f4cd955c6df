#include "softforce/estimation/location_estimator.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "estimation/location_state.h"
#include "softforce/base/input_error.h"

namespace softforce::estimation {

const char* Name(LocationMethod method) {
  switch (method) {
    case LocationMethod::kContinuous:
      return "continuous";
    case LocationMethod::kCandidates:
      return "candidates";
    case LocationMethod::kThreshold:
      return "threshold";
  }
  return "";
}

void LocationOptions::Check() const {
  estimator.Check();
  if (!(patch >= 0)) throw base::InputError("patch", "must be 0 or more");
  if (max_forces < 1) throw base::InputError("max_forces", "must be 1 or more");
  if (!(false_alarm > 0 && false_alarm < 1)) {
    throw base::InputError("false_alarm", "must lie between 0 and 1");
  }
  if (!(threshold >= 0 && threshold < 1)) {
    throw base::InputError("threshold", "must be 0 or more, and less than 1");
  }
  if (!(crease > 0)) throw base::InputError("crease", "must be greater than 0");
}

double LocatedForce::location_sd() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(location_covariance);
  return std::sqrt(std::max(0.0, axes.eigenvalues()(1)));
}

LocationEstimator::LocationEstimator(fem::StaticSolver* solver, const mesh::Surface& surface,
                                     std::vector<LocationCandidate> candidates,
                                     const LocationOptions& options) {
  options.Check();
  state_ = std::make_unique<State>(solver, surface, std::move(candidates), options);
}
LocationEstimator::~LocationEstimator() = default;
LocationEstimator::LocationEstimator(LocationEstimator&&) noexcept = default;

void LocationEstimator::SetRegistrationCovariance(const geometry::Matrix6d& covariance) {
  state_->registration_covariance = covariance;
}

fem::SolveSummary LocationEstimator::Advance(const fem::Actuation& actuation) {
  State& s = *state_;
  return s.MoveTo(s.NodalForces(s.forces), actuation, 1e-5 * s.diagonal, false);
}

LocationEstimate LocationEstimator::Estimate(const std::vector<Observation>& observations,
                                             const fem::Actuation& actuation,
                                             const fem::Equilibrium* shape) {
  State& s = *state_;
  const fem::Equilibrium before = s.state;
  const std::vector<TrialForce> forces_before = s.forces;
  LocationEstimate estimate;
  const auto converge = [&](const fem::Equilibrium* from) {
    estimate = s.Converge(observations, actuation, from);
    if (estimate.ok()) return;
    s.state = before;
    s.forces = forces_before;
    s.next_identity = s.first_new_identity;
  };
  const bool jump = shape != nullptr && s.IsJumpTo(*shape, observations);
  if (jump) converge(shape);
  if (!estimate.ok()) converge(nullptr);
  return estimate;
}

const fem::Equilibrium& LocationEstimator::state() const { return state_->state; }

const std::vector<LocationCandidate>& LocationEstimator::candidates() const {
  return state_->candidates;
}

std::vector<LocatedForce> LocationEstimator::Floor(const std::vector<Observation>& observations,
                                                   const std::vector<LocatedForce>& forces) const {
  State& s = *state_;
  std::vector<TrialForce> trials;
  for (const LocatedForce& force : forces) {
    TrialForce trial;
    trial.identity = force.identity;
    trial.candidate = force.candidate;
    trial.at = force.at;
    const PlacedPatch placed = s.faces.Place(force.at, s.candidates[force.candidate]);
    trial.intensity = placed.directions.transpose() * force.force;
    trials.push_back(trial);
  }
  const EstimatorOptions allowed = s.options.estimator;
  s.options.estimator.common_model_error = s.options.estimator.local_model_error = 0;
  const std::vector<char> none(observations.size(), 0);
  const std::vector<WhitenedObservation> used =
      s.WhitenAll(observations, none, std::vector<double>(observations.size(), 0));
  const bool ready = s.RefreshResponse(used);
  LinearisedPoints points;
  if (ready) points = s.Linearise(used, observations);
  s.options.estimator = allowed;
  std::string culprit;
  std::vector<LocatedForce> floor;
  if (!ready || !s.Describe(points, trials, &floor, &culprit)) return {};
  return floor;
}

}  // namespace softforce::estimation
