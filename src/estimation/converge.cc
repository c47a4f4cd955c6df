// Gauss–Newton on the converged equilibrium: see the class comment of ForceEstimator.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimation/force_estimator_state.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

// The model's error is scaled by the displacement, which the fit changes: repeated until it is
// settled to 20 %.
constexpr int kMaxScaleRounds = 4;
constexpr double kScaleTolerance = 0.2;
constexpr double kJump = 2;  // displacements: the body stands too near its rest to tell the scale

// A body that is being moved to new loads is first brought this near their equilibrium, as a share
// of its diagonal: enough to linearise about.
constexpr double kNearEquilibrium = 1e-5;
// A step of the loads is followed to this share of the movement that it makes.
constexpr double kFollowing = 0.02;
// Of the finest tolerance: near enough to tell a bad step from a body that is still on its way.
constexpr double kSettled = 0.01;
constexpr double kFinestTolerance = 1e-13;  // of the diagonal: rounding
constexpr int kPatience = 6;                // iterations, before the response is held to be stale
constexpr int kMaxHalvings = 8;
constexpr int kLoadHalvings = 1;  // within a step, which is itself halved if it fails

// Whether a cost (half of χ²) has not grown by more than the body's distance from its equilibrium
// can explain.
bool IsNoWorse(double cost, double before) {
  return cost <= before + 0.1 * std::sqrt(before) + 0.1;
}

}  // namespace

bool ForceEstimator::State::IsPossible(const Observation& observation) const {
  return observation.position.allFinite() && observation.whitening.allFinite() &&
         !observation.whitening.isZero(0) && observation.offset.allFinite() &&
         (observation.position - observation.at.Apply(solver->body().mesh.nodes)).norm() <
             kAbsurdDistance * diagonal;
}

double ForceEstimator::State::LargestDisplacement(
    const std::vector<Observation>& observations) const {
  double largest = 0;
  for (const Observation& seen : observations) {
    largest = std::max(largest, seen.at.Apply(body.state().u).norm());
  }
  return largest;
}

double ForceEstimator::State::SeenDisplacement(const std::vector<Observation>& observations) const {
  std::vector<double> displacements;
  for (const Observation& seen : observations) {
    if (!IsPossible(seen)) continue;
    displacements.push_back(
        (seen.position - seen.offset - seen.at.Apply(solver->body().mesh.nodes)).norm());
  }
  if (displacements.empty()) return 0;
  const auto at = displacements.begin() +
                  static_cast<std::ptrdiff_t>((1 - options.max_rejected_share) *
                                              static_cast<double>(displacements.size() - 1));
  std::nth_element(displacements.begin(), at, displacements.end());
  return *at;
}

std::vector<WhitenedObservation> ForceEstimator::State::WhitenAll(
    const std::vector<Observation>& observations, double displacement,
    ForceEstimate* estimate) const {
  const std::vector<int> companions = CountCompanions(observations);
  std::vector<WhitenedObservation> used;
  for (int i = 0; i < static_cast<int>(observations.size()); ++i) {
    estimate->rejected[i] = !IsPossible(observations[i]);
    if (estimate->rejected[i]) continue;
    used.push_back(
        Whiten(observations[i], i, options.local_model_error * displacement, companions[i]));
  }
  return used;
}

fem::SolveSummary ForceEstimator::State::MoveTo(const Eigen::VectorXd& loads,
                                                const fem::Actuation& told) {
  if (body.IsAt(loads, told)) {
    fem::SolveSummary there;
    there.status = fem::SolveSummary::Status::kConverged;
    there.reached_share = 1;
    return there;
  }
  return body.Move(loads, told, kNearEquilibrium * diagonal, false);
}

std::vector<ResidualBlock> ForceEstimator::State::Linearise(
    const std::vector<WhitenedObservation>& used, const OffsetPrior& prior,
    const Eigen::VectorXd& parameters, LoadedBody::Of response) const {
  const int n = num_loads() + 6;
  const geometry::Vector6d offset = parameters.tail<6>();
  std::vector<ResidualBlock> blocks;
  for (const WhitenedObservation& seen : used) {
    const Eigen::Vector3d on_model = body.Position(seen.observation->at);
    Eigen::MatrixXd J(3, n);
    J << body.Response(seen.observation->at, response), OffsetJacobian(on_model, prior);
    blocks.push_back(
        {seen.whitening * Misfit(*seen.observation, on_model, prior, offset), seen.whitening * J});
  }
  // The priors: whitening · (parameters from `first` on − mean).
  const auto add_prior = [&](int first, const Eigen::MatrixXd& whitening,
                             const Eigen::VectorXd& mean) {
    const auto size = whitening.cols();
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(whitening.rows(), n);
    J.middleCols(first, size) = whitening;
    blocks.push_back({whitening * (parameters.segment(first, size) - mean), J, false});
  };
  add_prior(num_loads(), prior.whitening, Eigen::VectorXd::Zero(6));
  for (int i = num_components(); i < num_loads(); ++i) {
    const double sd = actuators[body.uncertain()[i - num_components()]];
    if (std::isfinite(sd)) {
      add_prior(i, Eigen::MatrixXd::Constant(1, 1, 1 / sd), Eigen::VectorXd::Zero(1));
    }
  }
  const int n_forces = num_components();
  if (std::isfinite(options.force_scale) && n_forces > 0) {
    add_prior(0, Eigen::MatrixXd::Identity(n_forces, n_forces) / options.force_scale,
              Eigen::VectorXd::Zero(n_forces));
  }
  if (walk_covariance.size() > 0 && walk_covariance.allFinite()) {
    const Eigen::MatrixXd L = walk_covariance.llt().matrixL();
    add_prior(0, L.inverse(), last_intensity);
  }
  return blocks;
}

void ForceEstimator::State::Fit(const std::vector<WhitenedObservation>& used,
                                const OffsetPrior& prior, const fem::Actuation& told,
                                Eigen::VectorXd* parameters, std::vector<ResidualBlock>* blocks,
                                ForceEstimate* estimate) {
  using Status = ForceEstimate::Status;
  double sd = INFINITY;  // m
  for (const WhitenedObservation& seen : used) sd = std::min(sd, seen.sd);
  const double finest = std::max(options.tolerance * sd, kFinestTolerance * diagonal);
  const double negligible = 0.5 * options.tolerance * options.tolerance;  // of half of χ²
  const Bounds bounds = ParameterBounds(told);
  *blocks = Linearise(used, prior, *parameters);
  double followed_to = INFINITY;  // m, how near its equilibrium the body is
  bool renewed = false;           // the response, since the last step
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    ++estimate->iterations;
    const double cost = RobustCost(*blocks, *parameters, *parameters, options.loss_scale);
    const RobustFit fit =
        FitRobustly(*blocks, *parameters, *parameters, bounds, options.loss_scale);
    if (!fit.ok) break;
    if (cost - fit.cost <= negligible && followed_to <= finest) {
      estimate->status = Status::kOk;
      return;
    }
    const LoadedBody::Pose before = body.pose();
    const Eigen::VectorXd step =
        CarefulStep(used, *blocks, *parameters, fit.parameters - *parameters, bounds);
    bool moved = false;
    double share = 1;
    for (int halving = 0; halving <= kMaxHalvings && !moved; ++halving, share /= 2) {
      const Eigen::VectorXd trial = *parameters + share * step;
      const double move = body.MoveBy(trial.head(num_loads()) - before.loads);
      const double tolerance = std::max(finest, kFollowing * move);
      if (body.factorisations() - factorised_before > options.max_factorisations) break;
      if (!body.Move(trial.head(num_loads()), told, tolerance, iteration > 0, kLoadHalvings).ok()) {
        continue;
      }
      std::vector<ResidualBlock> there = Linearise(used, prior, trial);
      const double cost_there = RobustCost(there, trial, trial, options.loss_scale);
      moved = IsNoWorse(cost_there, cost);
      if (moved) {
        *parameters = trial;
        *blocks = std::move(there);
        followed_to = tolerance;
        renewed = false;
        continue;
      }
      body.Return(before);
      // Before it is blamed on the step: the body may have stood further from its equilibrium than
      // it seemed, and so have fitted better than it does; or its response may be stale. Then begin
      // again from there.
      if (followed_to > kSettled * finest) {
        moved = body.Move(before.loads, told, kSettled * finest, true, kLoadHalvings).ok();
        followed_to = kSettled * finest;
      } else if (!renewed) {
        moved = renewed = body.RenewResponse();
      }
      if (moved) *blocks = Linearise(used, prior, *parameters);
    }
    if (!moved) break;
    if (iteration % kPatience == kPatience - 1 && body.RenewResponse()) {
      *blocks = Linearise(used, prior, *parameters);
    }
  }
  estimate->status = Status::kNotConverged;
  estimate->reason = "the forces and the body's equilibrium under them did not settle";
}

ForceEstimate ForceEstimator::State::FitAndReject(const std::vector<Observation>& observations,
                                                  double displacement, const fem::Actuation& told) {
  using Status = ForceEstimate::Status;
  ForceEstimate estimate;
  estimate.rejected.assign(observations.size(), 0);
  std::vector<WhitenedObservation> used = WhitenAll(observations, displacement, &estimate);
  const double common_sd = options.common_model_error * displacement;
  const int most_rejected =
      static_cast<int>(options.max_rejected_share * static_cast<double>(used.size()));
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(num_loads() + 6);
  parameters.head(num_loads()) = body.pose().loads;
  for (int rejections = 0;; ++rejections) {
    const OffsetPrior prior =
        MakeOffsetPrior(used, solver->body().mesh.nodes, registration_covariance, common_sd);
    std::vector<ResidualBlock> blocks = Linearise(used, prior, parameters);
    if (!AreLoadsObservable(blocks, &estimate)) return estimate;
    Fit(used, prior, told, &parameters, &blocks, &estimate);
    if (!estimate.ok()) return estimate;

    estimate.chi2 = 0;
    int rows = 0, worst = -1;
    double worst_excess = 1;
    for (int i = 0; i < static_cast<int>(used.size()); ++i) {
      const int k = static_cast<int>(blocks[i].residual.size());
      const double chi2 = blocks[i].residual.squaredNorm();
      rows += k;
      estimate.chi2 += chi2;
      const double excess =
          chi2 / geometry::ChiSquareQuantile(1 - options.rejection_probability, k);
      if (excess > worst_excess) {
        worst_excess = excess;
        worst = i;
      }
    }
    estimate.degrees_of_freedom = rows - num_loads();
    if (worst < 0) {
      blocks = Linearise(used, prior, parameters, LoadedBody::Of::kTangent);
      if (AreLoadsObservable(blocks, &estimate)) Conclude(blocks, parameters, &estimate);
      return estimate;
    }
    if (rejections >= most_rejected) {
      estimate.status = Status::kInconsistent;
      estimate.reason = fmt::format(
          "after {} rejections there are still observations that no force explains", rejections);
      return estimate;
    }
    estimate.rejected[used[worst].index] = 1;
    used.erase(used.begin() + worst);
  }
}

ForceEstimate ForceEstimator::State::Converge(const std::vector<Observation>& observations,
                                              const fem::Actuation& told) {
  using Status = ForceEstimate::Status;
  ForceEstimate estimate;
  estimate.rejected.assign(observations.size(), 0);
  const fem::SolveSummary reached = MoveTo(AllowedLoads(ParameterBounds(told)), told);
  if (!reached.ok()) {
    estimate.status = Status::kNotConverged;
    estimate.reason = "the body has no equilibrium under the actuation: " + reached.BriefReport();
    return estimate;
  }
  factorised_before = body.factorisations();
  const double stood = LargestDisplacement(observations), seen = SeenDisplacement(observations);
  const bool jump = seen > kJump * stood;
  double scale = jump ? seen : stood;
  for (int round = 0; round < kMaxScaleRounds; ++round) {
    const int iterations = estimate.iterations;
    estimate = FitAndReject(observations, scale, told);
    estimate.iterations += iterations;
    // The model's error goes with how far the body has moved, which only the fit tells: after a
    // jump, fit again.
    const double fitted = LargestDisplacement(observations);
    const bool settled = (round > 0 || !jump) &&
                         std::abs(fitted - scale) <= kScaleTolerance * std::max(fitted, scale);
    scale = fitted;
    // Weighed as if the model were exact, right observations after a jump look impossible.
    const bool usable = estimate.ok() || estimate.status == Status::kInconsistent;
    if (!usable || settled) break;
  }
  return estimate;
}

}  // namespace softforce::estimation
