#include "softforce/estimation/force_estimator.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/equilibrium_problem.h"
#include "softforce/base/input_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

// The model's error is scaled by the displacement, which the fit changes: repeated until it is
// settled to 20 %.
constexpr int kMaxScaleRounds = 4;
constexpr double kScaleTolerance = 0.2;

bool IsFinite(const Observation& observation) {
  return observation.position.allFinite() && observation.whitening.allFinite() &&
         observation.offset.allFinite();
}

// The whitening matrix for R + model_sd² I, where `whitening` belongs to R. Directions that the
// measurement says nothing about (one camera) stay without a row.
Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> WithModelError(
    const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>& whitening, double model_sd) {
  const int rows = static_cast<int>(whitening.rows());
  const Eigen::Matrix3d information = whitening.transpose() * whitening;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);  // ascending
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> total(rows, 3);
  for (int i = 0; i < rows; ++i) {
    const int axis = 3 - rows + i;
    const double variance = 1 / axes.eigenvalues()(axis) + model_sd * model_sd;
    total.row(i) = axes.eigenvectors().col(axis).transpose() / std::sqrt(variance);
  }
  return total;
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
  require(loss_scale > 0, "loss_scale", "must be greater than 0");
  require(rejection_probability > 0 && rejection_probability < 1, "rejection_probability",
          "must lie between 0 and 1");
  require(max_rejected_share >= 0 && max_rejected_share < 1, "max_rejected_share",
          "must be at least 0 and below 1");
  require(min_singular_ratio > 0, "min_singular_ratio", "must be greater than 0");
  require(max_iterations >= 1, "max_iterations", "must be 1 or more");
  require(cost_tolerance > 0, "cost_tolerance", "must be greater than 0");
  require(max_staleness >= 0, "max_staleness", "must be 0 m or more");
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
  }
  return "";
}

std::string ForceEstimate::BriefReport() const {
  if (!ok()) return fmt::format("{}: {}", Name(status), reason);
  return fmt::format("ok: chi2 {:.1f} of {} degrees of freedom, {} iterations, {} factorisations",
                     chi2, degrees_of_freedom, iterations, factorisations);
}

ForceEstimator::ForceEstimator(fem::StaticSolver* solver, std::vector<ForceSite> sites,
                               const EstimatorOptions& options)
    : solver_(solver), sites_(std::move(sites)), options_(options) {
  options_.Check();
  const int num_nodes = solver_->body().mesh.num_nodes();
  H_f_ = Eigen::MatrixXd::Zero(3 * num_nodes, FirstComponent(static_cast<int>(sites_.size())));
  for (int s = 0; s < static_cast<int>(sites_.size()); ++s) {
    const ForceSite& site = sites_[s];
    for (size_t i = 0; i < site.at.nodes.size(); ++i) {
      H_f_.block(3 * site.at.nodes[i], FirstComponent(s), 3, site.directions.cols()) =
          site.at.weights[i] * site.directions;
    }
  }
  state_ = solver_->AtRest();
  intensity_ = state_intensity_ = Eigen::VectorXd::Zero(num_components());
}

int ForceEstimator::FirstComponent(int site) const {
  int first = 0;
  for (int s = 0; s < site; ++s) first += static_cast<int>(sites_[s].directions.cols());
  return first;
}

fem::LoadCase ForceEstimator::LoadOf(const Eigen::VectorXd& intensity,
                                     const fem::Actuation& actuation) const {
  return {(H_f_ * intensity).reshaped(3, H_f_.rows() / 3), actuation};
}

fem::SolveSummary ForceEstimator::Advance(const fem::Actuation& actuation) {
  fem::SolveSummary summary = solver_->Solve(LoadOf(intensity_, actuation), &state_);
  if (summary.ok() && !RefreshCompliance()) {
    summary.status = fem::SolveSummary::Status::kNotConverged;
  }
  return summary;
}

bool ForceEstimator::RefreshCompliance() {
  const Eigen::Array<bool, Eigen::Dynamic, 1> taut = state_.tension.array() > 0;
  const bool fresh =
      compliance_u_.cols() == state_.u.cols() && (taut == compliance_taut_).all() &&
      (state_.u - compliance_u_).colwise().norm().maxCoeff() <= options_.max_staleness;
  if (fresh) return true;
  fem::Sensitivity sensitivity = solver_->Solve(state_, H_f_, options_.max_staleness);
  if (!sensitivity.ok) return false;
  compliance_ = std::move(sensitivity.du);
  compliance_u_ = state_.u;
  compliance_taut_ = taut;
  return true;
}

Eigen::Matrix3Xd ForceEstimator::Compliance(const mesh::NodalWeights& at) const {
  Eigen::Matrix3Xd W = Eigen::Matrix3Xd::Zero(3, num_components());
  for (size_t i = 0; i < at.nodes.size(); ++i) {
    W += at.weights[i] * compliance_.middleRows<3>(3 * at.nodes[i]);
  }
  return W;
}

double ForceEstimator::LargestDisplacement(const std::vector<Observation>& observations) const {
  double largest = 0;
  for (const Observation& seen : observations) {
    largest = std::max(largest, seen.at.Apply(state_.u).norm());
  }
  return largest;
}

std::vector<WhitenedObservation> ForceEstimator::Whiten(
    const std::vector<Observation>& observations, double displacement,
    ForceEstimate* estimate) const {
  std::vector<WhitenedObservation> used;
  for (int i = 0; i < static_cast<int>(observations.size()); ++i) {
    const Observation& seen = observations[i];
    estimate->rejected[i] = !IsFinite(seen);
    if (estimate->rejected[i]) continue;
    used.push_back(
        {i, &seen, WithModelError(seen.whitening, options_.local_model_error * displacement)});
  }
  return used;
}

ForceEstimate ForceEstimator::Estimate(const std::vector<Observation>& observations,
                                       const fem::Actuation& actuation) {
  const fem::Equilibrium before = state_;
  const Eigen::VectorXd intensity_before = intensity_;
  ForceEstimate estimate;
  double scale = LargestDisplacement(observations);
  for (int round = 0; round < kMaxScaleRounds; ++round) {
    estimate = ForceEstimate();
    estimate.rejected.assign(observations.size(), 0);
    FitAndReject(Whiten(observations, scale, &estimate), options_.common_model_error * scale,
                 actuation, &estimate);
    // The model's error goes with how far the body has moved, which only the fit tells: after a
    // jump, fit again.
    const double fitted = LargestDisplacement(observations);
    const bool settled = std::abs(fitted - scale) <= kScaleTolerance * std::max(fitted, scale);
    scale = fitted;
    // Weighed as if the model were exact, right observations after a jump look impossible.
    const bool usable = estimate.ok() || estimate.status == ForceEstimate::Status::kInconsistent;
    if (!usable || settled) break;
  }
  if (!estimate.ok()) {
    state_ = before;
    intensity_ = state_intensity_ = intensity_before;
  }
  return estimate;
}

void ForceEstimator::FitAndReject(std::vector<WhitenedObservation> used, double common_sd,
                                  const fem::Actuation& actuation, ForceEstimate* estimate) {
  const BodyResponse body = Response(actuation, estimate);
  const int n = num_components();
  const int most_rejected = static_cast<int>(options_.max_rejected_share *
                                             static_cast<double>(estimate->rejected.size()));
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(n + 6);
  for (int rejections = 0;; ++rejections) {
    int rows = 0;
    for (const WhitenedObservation& seen : used) rows += static_cast<int>(seen.whitening.rows());
    if (rows < n) {  // Theorem 2
      estimate->status = ForceEstimate::Status::kTooFewObservations;
      estimate->reason =
          fmt::format("{} measured coordinates for {} unknown force components", rows, n);
      return;
    }
    const OffsetPrior prior = MakeOffsetPrior(used, common_sd);
    parameters.head(n) = intensity_;
    const FitResult fit = FitParameters(used, parameters, prior, body, options_);
    estimate->iterations += fit.iterations;
    const Eigen::VectorXd found = fit.parameters.head(n);
    const bool reached = fit.converged && (found == state_intensity_ || body.move(found));
    if (!reached) {
      estimate->status = ForceEstimate::Status::kNotConverged;
      estimate->reason =
          fit.converged ? "the body found no equilibrium under the forces" : fit.message;
      return;
    }
    parameters = fit.parameters;
    intensity_ = parameters.head(n);

    Eigen::MatrixXd J(rows + 6, n + 6);
    const int worst = Assess(used, prior, body, parameters, &J, estimate);
    estimate->degrees_of_freedom = rows - n;
    if (worst < 0) {
      Conclude(J, parameters, estimate);
      return;
    }
    if (rejections >= most_rejected) {
      estimate->status = ForceEstimate::Status::kInconsistent;
      estimate->reason = fmt::format(
          "after {} rejections there are still observations that no force explains", rejections);
      return;
    }
    estimate->rejected[used[worst].index] = 1;
    used.erase(used.begin() + worst);
  }
}

BodyResponse ForceEstimator::Response(const fem::Actuation& actuation, ForceEstimate* estimate) {
  BodyResponse body;
  body.move = [this, actuation, estimate](const Eigen::VectorXd& intensity) {
    if (!intensity.allFinite()) return false;
    // A small change starts from the linear answer; Newton's method does the rest. Over a large one
    // the linear answer stretches what should turn, and the old shape is the better start.
    fem::Equilibrium trial = state_;
    bool predicted = false;
    if (compliance_u_.cols() == state_.u.cols()) {
      const Eigen::Matrix3Xd du =
          (compliance_ * (intensity - state_intensity_)).reshaped(3, trial.u.cols());
      predicted = du.colwise().norm().maxCoeff() <= options_.max_staleness;
      if (predicted) trial.u += du;
    }
    const fem::LoadCase load = LoadOf(intensity, actuation);
    fem::SolveSummary summary = solver_->Solve(load, &trial);
    if (!summary.ok() && predicted) {
      trial = state_;
      summary = solver_->Solve(load, &trial);
    }
    estimate->factorisations += summary.factorisations;
    if (!summary.ok()) return false;
    state_ = std::move(trial);
    state_intensity_ = intensity;
    return RefreshCompliance();
  };
  body.position = [this](const mesh::NodalWeights& at) -> Eigen::Vector3d {
    return at.Apply(solver_->body().mesh.nodes) + at.Apply(state_.u);
  };
  body.compliance = [this](const mesh::NodalWeights& at) { return Compliance(at); };
  return body;
}

Eigen::Vector3d ForceEstimator::Force(const Eigen::VectorXd& intensity, int site) const {
  const Eigen::Matrix3Xd& directions = sites_[site].directions;
  return directions * intensity.segment(FirstComponent(site), directions.cols());
}

Eigen::Matrix3d ForceEstimator::ForceCovariance(const Eigen::MatrixXd& covariance, int site) const {
  const Eigen::Matrix3Xd& directions = sites_[site].directions;
  const int first = FirstComponent(site);
  const int n = static_cast<int>(directions.cols());
  return directions * covariance.block(first, first, n, n) * directions.transpose();
}

}  // namespace softforce::estimation
