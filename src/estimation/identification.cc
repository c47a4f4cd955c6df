#include "softforce/estimation/identification.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "estimation/identification_input.h"
#include "estimation/identification_task.h"

namespace softforce::estimation {
namespace {

using Kind = Unknown::Kind;
using Status = Identification::Status;

// The model's error is scaled by the displacements, which the fit changes: repeated until they are
// settled to 20 %, as for forces.
constexpr int kMaxScaleRounds = 6;
constexpr double kScaleTolerance = 0.2;

bool IsFinite(const Observation& seen) {
  return seen.position.allFinite() && seen.whitening.allFinite() && seen.offset.allFinite();
}

double Guess(const Unknown& unknown, const fem::Actuation& actuation,
             const IdentificationOptions& options) {
  if (unknown.kind == Kind::kYoungsModulus) return options.guess_log_modulus;
  if (unknown.kind == Kind::kPoissonsRatio) return options.guess_poissons_ratio;
  return actuation.cables[unknown.cable].input == fem::CableInput::kTension
             ? options.guess_tension
             : options.guess_shortening;
}

}  // namespace

IdentificationTask::IdentificationTask(const fem::Body& body, const std::vector<KnownState>& states,
                                       const std::vector<Unknown>& unknowns,
                                       const geometry::Matrix6d& registration,
                                       const IdentificationOptions& options)
    : states_(states),
      unknowns_(unknowns),
      options_(options),
      rest_(body),
      body_(body, states, unknowns, options),
      guess_(unknowns.size()),
      prior_sd_(unknowns.size()) {
  for (size_t p = 0; p < unknowns.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    guess_(i) = Guess(unknowns[p], states.front().actuation, options);
    prior_sd_(i) = unknowns[p].prior_sd;
  }
  RefuseUnusable();
  std::vector<WhitenedObservation> all;  // for where they are
  for (size_t s = 0; s < states.size(); ++s) {
    for (size_t i = 0; i < states[s].observations.size(); ++i) {
      if (!result_.rejected[s][i]) all.push_back({0, &states[s].observations[i], {}, 0});
    }
  }
  offset_ = MakeOffsetModel(CloudOf(all, body.mesh.nodes), registration);
  fit_.emplace(&body_, states_, result_.rejected, offset_, guess_, prior_sd_, options_);
  parameters_ = Eigen::VectorXd::Zero(fit_->num_parameters());
}

void IdentificationTask::RefuseUnusable() {
  for (const KnownState& state : states_) {
    std::vector<char> rejected(state.observations.size(), 0);
    for (size_t i = 0; i < rejected.size(); ++i) rejected[i] = !IsFinite(state.observations[i]);
    result_.rejected.push_back(rejected);
  }
}

void IdentificationTask::Fail(Status status, const std::string& reason) {
  result_.status = status;
  result_.reason = reason;
}

bool IdentificationTask::EnoughObservations() {
  const int n = body_.num_unknowns();
  if (fit_->num_rows() >= n) return true;
  Fail(Status::kTooFewObservations,
       fmt::format("{} measured coordinates for {} unknowns", fit_->num_rows(), n));
  return false;
}

std::vector<double> IdentificationTask::Displacements() const {
  std::vector<double> largest(states_.size(), 0);
  for (size_t s = 0; s < states_.size(); ++s) {
    for (size_t i = 0; i < states_[s].observations.size(); ++i) {
      if (result_.rejected[s][i]) continue;
      largest[s] =
          std::max(largest[s],
                   body_.Displacement(static_cast<int>(s), states_[s].observations[i].at).norm());
    }
  }
  return largest;
}

bool IdentificationTask::Fit() {
  const IdentificationFit::Result fit = fit_->Minimise(&parameters_);
  result_.iterations += fit.iterations;
  if (Stopped()) return false;
  const bool reached = fit.converged && body_.MoveTo(fit_->Theta(parameters_));
  if (!reached) {
    Fail(Status::kNotConverged, fit.converged ? "a state has no equilibrium" : WhyNotSettled());
  }
  return reached;
}

bool IdentificationTask::Stopped() {
  const bool stopped = options_.stop != nullptr && *options_.stop;
  if (stopped) Fail(Status::kStopped, "stopped during the fit");
  return stopped;
}

bool IdentificationTask::FitToSettledScale() {
  for (int round = 0; round < kMaxScaleRounds; ++round) {
    if (!Fit()) return false;
    const std::vector<double> before = displacements_;
    displacements_ = Displacements();
    bool settled = true;
    for (size_t s = 0; s < states_.size(); ++s) {
      const double larger = std::max(before[s], displacements_[s]);
      settled &= std::abs(before[s] - displacements_[s]) <= kScaleTolerance * larger;
    }
    fit_->SetDisplacements(displacements_);
    if (settled) break;
  }
  return true;
}

bool IdentificationTask::RejectAndFit() {
  size_t observations = 0;
  for (const KnownState& state : states_) observations += state.observations.size();
  const int most =
      static_cast<int>(options_.estimator.max_rejected_share * static_cast<double>(observations));
  for (int rejections = 0;; ++rejections) {
    const auto [state, number] = fit_->MostImpossible(parameters_);
    if (state < 0) return true;
    if (rejections >= most) {
      Fail(Status::kInconsistent,
           fmt::format("after {} rejections there are still observations that the body does not "
                       "explain",
                       rejections));
      return false;
    }
    result_.rejected[state][number] = 1;
    displacements_ = Displacements();
    fit_->SetDisplacements(displacements_);
    if (!EnoughObservations() || !Fit()) return false;
  }
}

Eigen::MatrixXd IdentificationTask::InformationOnUnknowns(bool with_loss) const {
  const Eigen::MatrixXd all = fit_->Information(parameters_, with_loss);
  const int n = body_.num_unknowns();
  const int rest = fit_->num_parameters() - n;
  // What is left once the offsets, which are unknown too, have taken their part.
  return all.topLeftCorner(n, n) -
         all.topRightCorner(n, rest) *
             all.bottomRightCorner(rest, rest).ldlt().solve(all.bottomLeftCorner(rest, n));
}

bool IdentificationTask::Observable() {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(InformationOnUnknowns(false));
  if (spectrum.eigenvalues()(0) >= 1) return true;
  Fail(Status::kUnobservable, Why(spectrum.eigenvectors().col(0)));
  return false;
}

bool IdentificationTask::InRange() {
  constexpr double kMargin = 1e-6;
  const Eigen::VectorXd theta = fit_->Theta(parameters_);
  for (int p = 0; p < body_.num_unknowns(); ++p) {
    const bool inside = theta(p) > body_.Lower(p) + kMargin && theta(p) < body_.Upper(p) - kMargin;
    if (inside) continue;
    Fail(Status::kOutOfRange,
         fmt::format("{} ends at the limit of its range, {:.4g} away from where it started",
                     unknowns_[p].name, theta(p)));
    return false;
  }
  return true;
}

Identification IdentificationTask::Run() {
  displacements_.assign(states_.size(), 0);
  if (Stopped()) return result_;
  if (!body_.MoveTo(fit_->Theta(parameters_))) {
    Fail(Status::kNotConverged,
         "a state has no equilibrium with the values to start from: check the weights and their "
         "units, or start from stiffer material");
    return result_;
  }
  displacements_ = Displacements();
  fit_->SetDisplacements(displacements_);
  if (EnoughObservations() && Observable() && FitToSettledScale() && RejectAndFit() &&
      Observable() && InRange()) {
    result_.status = Status::kOk;
    Conclude();
  }
  if (result_.iterations > 0 && result_.status != Status::kNotConverged &&
      result_.status != Status::kStopped) {
    result_.chi2 = fit_->ChiSquare(parameters_);
    result_.degrees_of_freedom = fit_->num_rows() - body_.num_unknowns();
    for (int s = 0; s < static_cast<int>(states_.size()); ++s) {
      result_.states.push_back(DescribeState(s));
    }
  }
  result_.factorisations = body_.factorisations();
  return result_;
}

Identification Identify(const fem::Body& body, const std::vector<KnownState>& states,
                        const std::vector<Unknown>& unknowns,
                        const geometry::Matrix6d& registration_covariance,
                        const IdentificationOptions& options) {
  options.Check();
  CheckInput(body, states, unknowns);
  return IdentificationTask(body, states, unknowns, registration_covariance, options).Run();
}

}  // namespace softforce::estimation
