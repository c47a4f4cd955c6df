#include "softforce/estimation/identification.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "estimation/identification_fit.h"
#include "estimation/identification_input.h"

namespace softforce::estimation {
namespace {

using Kind = Unknown::Kind;
using Status = Identification::Status;

// The model's error is scaled by the displacements, which the fit changes: repeated until they are
// settled to 20 %, as for forces.
constexpr int kMaxScaleRounds = 6;
constexpr double kScaleTolerance = 0.2;
constexpr double kShare = 0.1;  // of a unit vector: smaller parts of a combination do not matter

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

const char* UnitOf(const Unknown& unknown, const std::vector<KnownState>& states) {
  if (unknown.kind != Kind::kCableOffset) return "";
  const fem::CableCommand& told = states.front().actuation.cables[unknown.cable];
  return told.input == fem::CableInput::kTension ? "N" : "m";
}

// One identification under way.
class Task {
 public:
  Task(const fem::Body& body, const std::vector<KnownState>& states,
       const std::vector<Unknown>& unknowns, const geometry::Matrix6d& registration,
       const IdentificationOptions& options);

  Identification Run();

 private:
  void RefuseUnusable();
  bool EnoughObservations();
  std::vector<double> Displacements() const;
  bool FitToSettledScale();
  bool Fit();
  bool Stopped();
  std::string WhyNotSettled() const;
  bool RejectAndFit();
  Eigen::MatrixXd InformationOnUnknowns(bool with_loss) const;
  bool Observable();
  bool InRange();
  std::string Why(const Eigen::VectorXd& combination) const;
  void Conclude();
  StateFit DescribeState(int state) const;
  void Fail(Status status, const std::string& reason);

  const std::vector<KnownState>& states_;
  const std::vector<Unknown>& unknowns_;
  const IdentificationOptions& options_;
  const fem::Body& rest_;
  ParametricBody body_;
  OffsetModel offset_;
  Eigen::VectorXd guess_, prior_sd_;
  Identification result_;
  std::vector<double> displacements_;
  std::optional<IdentificationFit> fit_;
  Eigen::VectorXd parameters_;
};

Task::Task(const fem::Body& body, const std::vector<KnownState>& states,
           const std::vector<Unknown>& unknowns, const geometry::Matrix6d& registration,
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

void Task::RefuseUnusable() {
  for (const KnownState& state : states_) {
    std::vector<char> rejected(state.observations.size(), 0);
    for (size_t i = 0; i < rejected.size(); ++i) rejected[i] = !IsFinite(state.observations[i]);
    result_.rejected.push_back(rejected);
  }
}

void Task::Fail(Status status, const std::string& reason) {
  result_.status = status;
  result_.reason = reason;
}

bool Task::EnoughObservations() {
  const int n = body_.num_unknowns();
  if (fit_->num_rows() >= n) return true;
  Fail(Status::kTooFewObservations,
       fmt::format("{} measured coordinates for {} unknowns", fit_->num_rows(), n));
  return false;
}

std::vector<double> Task::Displacements() const {
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

bool Task::Fit() {
  const IdentificationFit::Result fit = fit_->Minimise(&parameters_);
  result_.iterations += fit.iterations;
  if (Stopped()) return false;
  const bool reached = fit.converged && body_.MoveTo(fit_->Theta(parameters_));
  if (!reached) {
    Fail(Status::kNotConverged, fit.converged ? "a state has no equilibrium" : WhyNotSettled());
  }
  return reached;
}

bool Task::Stopped() {
  const bool stopped = options_.stop != nullptr && *options_.stop;
  if (stopped) Fail(Status::kStopped, "stopped during the fit");
  return stopped;
}

// The least-squares solver speaks of its own iterations; what helps is where the values went.
std::string Task::WhyNotSettled() const {
  const Eigen::VectorXd theta = fit_->Theta(parameters_);
  std::string values;
  for (int p = 0; p < body_.num_unknowns(); ++p) {
    const Unknown& unknown = unknowns_[p];
    if (p > 0) values += ", ";
    if (unknown.kind == Kind::kYoungsModulus) {
      values += fmt::format("{} at {:.3g} times its start", unknown.name, std::exp(theta(p)));
    } else {
      values +=
          fmt::format("{} changed by {:+.3g} {}", unknown.name, theta(p), UnitOf(unknown, states_));
    }
  }
  return fmt::format(
      "no values were found that bring the model to what was seen (given up with {}); check the "
      "weights' signs, units and frames; if what is not sought for is wrong, too, such as Young's "
      "modulus, let it be found as well",
      values);
}

bool Task::FitToSettledScale() {
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

bool Task::RejectAndFit() {
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

Eigen::MatrixXd Task::InformationOnUnknowns(bool with_loss) const {
  const Eigen::MatrixXd all = fit_->Information(parameters_, with_loss);
  const int n = body_.num_unknowns();
  const int rest = fit_->num_parameters() - n;
  // What is left once the offsets, which are unknown too, have taken their part.
  return all.topLeftCorner(n, n) -
         all.topRightCorner(n, rest) *
             all.bottomRightCorner(rest, rest).ldlt().solve(all.bottomLeftCorner(rest, n));
}

std::string Task::Why(const Eigen::VectorXd& combination) const {
  std::string names;
  int count = 0;
  bool modulus = false;
  for (int p = 0; p < body_.num_unknowns(); ++p) {
    if (std::abs(combination(p)) < kShare) continue;
    names += (count++ == 0 ? "" : ", ") + unknowns_[p].name;
    modulus |= unknowns_[p].kind == Kind::kYoungsModulus;
  }
  if (count > 1) return "what was seen cannot tell apart " + names;
  std::string why = "what was seen says next to nothing about " + names;
  bool pulled = !rest_.gravity.isZero(0);
  for (const KnownState& state : states_) {
    pulled |= !state.forces.isZero(0);
    for (const double pressure : state.actuation.pressures) pulled |= pressure != 0;
    for (const fem::CableCommand& cable : state.actuation.cables) {
      pulled |= cable.input == fem::CableInput::kTension && cable.value != 0;
    }
  }
  if (modulus && !pulled) {
    why +=
        ": no state has a weight, a pressure or a tension, and the shape under cables of known "
        "shortening is the same for a stiff body and a soft one";
  }
  return why;
}

bool Task::Observable() {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(InformationOnUnknowns(false));
  if (spectrum.eigenvalues()(0) >= 1) return true;
  Fail(Status::kUnobservable, Why(spectrum.eigenvectors().col(0)));
  return false;
}

bool Task::InRange() {
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

void Task::Conclude() {
  const Eigen::VectorXd theta = fit_->Theta(parameters_);
  result_.change = theta;
  result_.covariance =
      guess_.asDiagonal() * InformationOnUnknowns(true).inverse() * guess_.asDiagonal();
  result_.materials = body_.Materials(theta);
  result_.cable_offsets = body_.CableOffsets(theta);
  for (int p = 0; p < body_.num_unknowns(); ++p) {
    const Unknown& unknown = unknowns_[p];
    const int region = unknown.regions.empty() ? 0 : unknown.regions.front();
    const double sd = std::sqrt(result_.covariance(p, p));
    IdentifiedValue value{unknown.name, "", 0, theta(p), sd};
    if (unknown.kind == Kind::kYoungsModulus) {
      value.unit = "Pa";
      value.start = rest_.materials[region].youngs_modulus;
      value.value = result_.materials[region].youngs_modulus;
      value.sd = value.value * sd;
    } else if (unknown.kind == Kind::kPoissonsRatio) {
      value.start = rest_.materials[region].poissons_ratio;
      value.value = result_.materials[region].poissons_ratio;
    } else {
      value.unit = UnitOf(unknown, states_);
    }
    result_.values.push_back(value);
  }
}

StateFit Task::DescribeState(int s) const {
  StateFit state;
  state.name = states_[s].name;
  state.displacement = displacements_[s];
  state.offset = fit_->Offset(s, parameters_);
  double squares = 0, squares_offset = 0;
  for (size_t i = 0; i < states_[s].observations.size(); ++i) {
    if (result_.rejected[s][i]) {
      ++state.rejected;
      continue;
    }
    ++state.observations;
    const Observation& seen = states_[s].observations[i];
    const Eigen::Vector3d arm = body_.Position(s, seen.at) - offset_.about.centre;
    const Eigen::Vector3d misfit = fit_->Misfit(s, seen, parameters_);
    squares_offset += misfit.squaredNorm();
    squares += (misfit - state.offset.translation - state.offset.rotation.cross(arm)).squaredNorm();
  }
  state.rms = std::sqrt(squares / std::max(1, state.observations));
  state.rms_offset = std::sqrt(squares_offset / std::max(1, state.observations));
  return state;
}

Identification Task::Run() {
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

}  // namespace

Identification Identify(const fem::Body& body, const std::vector<KnownState>& states,
                        const std::vector<Unknown>& unknowns,
                        const geometry::Matrix6d& registration_covariance,
                        const IdentificationOptions& options) {
  options.Check();
  CheckInput(body, states, unknowns);
  return Task(body, states, unknowns, registration_covariance, options).Run();
}

}  // namespace softforce::estimation
