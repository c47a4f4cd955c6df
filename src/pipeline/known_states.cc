#include "pipeline/known_states.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace softforce::pipeline {
namespace {

// Commands closer than this share of the largest in the table are the same.
constexpr double kSameCommand = 1e-3;

std::vector<double> Commands(const fem::Actuation& actuation) {
  std::vector<double> commands;
  for (const fem::CableCommand& cable : actuation.cables) commands.push_back(cable.value);
  commands.insert(commands.end(), actuation.pressures.begin(), actuation.pressures.end());
  return commands;
}

}  // namespace

KnownStates::KnownStates(const scene::Scene& scene, const World& world,
                         const std::vector<KnownWeights>& weights)
    : world_(world), weights_(weights) {
  if (scene.actuators.empty()) return;
  tolerance_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scene.actuators.size()));
  for (const double time : scene.actuation.time_s) {
    const std::vector<double> commands = Commands(ActuationAt(scene, time));
    const Eigen::Map<const Eigen::VectorXd> now(commands.data(), tolerance_.size());
    tolerance_ = tolerance_.cwiseMax(kSameCommand * now.cwiseAbs());
  }
}

bool KnownStates::Wants(int frame) const {
  return std::any_of(weights_.begin(), weights_.end(),
                     [&](const KnownWeights& weights) { return weights.Contains(frame); });
}

int KnownStates::end_frame() const {
  int end = 0;
  for (const KnownWeights& weights : weights_) end = std::max(end, weights.end_frame);
  return end;
}

bool KnownStates::SameActuation(const fem::Actuation& a, const fem::Actuation& b) const {
  const std::vector<double> one = Commands(a), other = Commands(b);
  for (size_t i = 0; i < one.size(); ++i) {
    if (std::abs(one[i] - other[i]) > tolerance_(static_cast<Eigen::Index>(i))) return false;
  }
  return true;
}

void KnownStates::Add(int frame, const fem::Actuation& actuation,
                      const std::vector<MarkerObservation>& observations) {
  int spec = 0;
  while (!weights_[spec].Contains(frame)) ++spec;
  auto state = std::find_if(collected_.begin(), collected_.end(), [&](const State& known) {
    return known.spec == spec && SameActuation(known.actuation, actuation);
  });
  if (state == collected_.end()) {
    collected_.push_back({spec, frame, frame, 0, actuation, {}});
    state = collected_.end() - 1;
  }
  state->last_frame = frame;
  ++state->frames;
  for (const MarkerObservation& observation : observations) {
    const estimation::Observation& seen = observation.seen;
    Feature& feature = state->features[observation.feature];
    if (feature.frames++ == 0) feature.first = observation;
    const Eigen::Matrix3d information = seen.whitening.transpose() * seen.whitening;
    feature.information += information;
    feature.weighted += information * seen.position;
  }
}

estimation::Observation KnownStates::Mean(const Feature& feature) const {
  constexpr double kNoInformation = 1e-9;  // of the largest: a direction that no camera sees
  estimation::Observation mean = feature.first.seen;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(feature.information);  // ascending
  const Eigen::Vector3d information = axes.eigenvalues();
  const Eigen::Matrix3d R = axes.eigenvectors();
  int first = 0;
  while (first < 2 && information(first) <= kNoInformation * information(2)) ++first;
  mean.position = R.rightCols(3 - first) * (R.rightCols(3 - first).transpose() * feature.weighted)
                                               .cwiseQuotient(information.tail(3 - first));
  mean.whitening = (information.tail(3 - first) / feature.frames).cwiseSqrt().asDiagonal() *
                   R.rightCols(3 - first).transpose();
  return mean;
}

Eigen::Matrix3Xd KnownStates::Forces(const KnownWeights& weights) const {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, world_.mesh().num_nodes());
  for (const auto& [candidate, components] : weights.forces) {
    const estimation::ForceSite& site = world_.sites[candidate];
    for (size_t i = 0; i < site.at.nodes.size(); ++i) {
      forces.col(site.at.nodes[i]) += site.at.weights[i] * (site.directions * components);
    }
  }
  return forces;
}

std::vector<estimation::KnownState> KnownStates::Collected() const {
  std::vector<estimation::KnownState> states;
  for (const State& collected : collected_) {
    estimation::KnownState state;
    state.name = collected.frames == 1
                     ? fmt::format("frame {}", collected.first_frame)
                     : fmt::format("frames {} to {}", collected.first_frame, collected.last_frame);
    state.forces = Forces(weights_[collected.spec]);
    state.actuation = collected.actuation;
    state.group = collected.spec;
    for (const auto& [number, feature] : collected.features) {
      state.observations.push_back(Mean(feature));
      state.points.push_back(number);
    }
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace softforce::pipeline
