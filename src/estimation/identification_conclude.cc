// What an identification says of its result, or of why it has none.
#include "estimation/identification_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace softforce::estimation {
namespace {

using Kind = Unknown::Kind;

constexpr double kShare = 0.1;  // of a unit vector: smaller parts of a combination do not matter

const char* UnitOf(const Unknown& unknown, const std::vector<KnownState>& states) {
  if (unknown.kind != Kind::kCableOffset) return "";
  const fem::CableCommand& told = states.front().actuation.cables[unknown.cable];
  return told.input == fem::CableInput::kTension ? "N" : "m";
}

}  // namespace

// The least-squares solver speaks of its own iterations; what helps is where the values went.
std::string IdentificationTask::WhyNotSettled() const {
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

std::string IdentificationTask::Why(const Eigen::VectorXd& combination) const {
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

void IdentificationTask::Conclude() {
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

StateFit IdentificationTask::DescribeState(int s) const {
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

}  // namespace softforce::estimation
