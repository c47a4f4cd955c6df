#include "pipeline/known_states.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "softforce/geometry/chi_square.h"

namespace softforce::pipeline {
namespace {

// Commands closer than this share of the largest in the table are the same.
constexpr double kSameCommand = 1e-3;

// A feature moves if chance lets noise scatter it so with this probability only, and if it goes
// further than this share of what the body is displaced: so much hardly shows in the values found.
constexpr double kChance = 1e-6;
constexpr double kAtRest = 0.005;

// Directions that no camera sees have less than this share of the largest information.
constexpr double kNoInformation = 1e-9;

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
    feature.all.push_back(seen);
  }
}

estimation::Observation KnownStates::Mean(const Feature& feature) const {
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

KnownStates::Scatter KnownStates::ScatterOf(const Feature& feature) const {
  // From the first place on, so that what no camera sees plays no part.
  const estimation::Observation& first = feature.first.seen;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(feature.information);  // ascending
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  int seen_directions = 0;
  for (int i = 0; i < 3; ++i) {
    if (axes.eigenvalues()(i) <= kNoInformation * axes.eigenvalues()(2)) continue;
    inverse(i) = 1 / axes.eigenvalues()(i);
    ++seen_directions;
  }
  const Eigen::Matrix3d& R = axes.eigenvectors();
  const Eigen::Vector3d mean =
      R * inverse.asDiagonal() * R.transpose() *
      (feature.weighted - feature.information * first.position);  // less the first place
  double chi2 = 0, squares = 0;
  int rows = 0;
  for (const estimation::Observation& seen : feature.all) {
    const Eigen::VectorXd whitened = seen.whitening * (seen.position - first.position - mean);
    const Eigen::MatrixXd gram = seen.whitening * seen.whitening.transpose();
    chi2 += whitened.squaredNorm();
    squares += whitened.dot(gram.ldlt().solve(whitened));
    rows += static_cast<int>(whitened.size());
  }
  Scatter scatter;
  scatter.displacement =
      (first.position + mean - first.at.Apply(world_.mesh().nodes) - first.offset).norm();
  const int degrees_of_freedom = rows - seen_directions;
  if (feature.frames < 2 || degrees_of_freedom < 1) return scatter;
  scatter.rms = std::sqrt(squares / (feature.frames - 1));
  scatter.is_noise = chi2 <= geometry::ChiSquareQuantile(1 - kChance, degrees_of_freedom);
  return scatter;
}

double KnownStates::Displacement(const State& state) const {
  double displacement = 0;
  for (const auto& [number, feature] : state.features) {
    displacement = std::max(displacement, ScatterOf(feature).displacement);
  }
  return displacement;
}

std::string KnownStates::Movement(const State& state, const scene::Scene& scene) const {
  double displacement = Displacement(state);
  if (weights_[state.spec].forces.empty()) {
    // Without a weight the body may hardly be displaced: trembling counts beside what weights do.
    for (const State& other : collected_) {
      displacement = std::max(displacement, Displacement(other));
    }
  }
  std::set<int> seen, moving;  // markers: the corners of a tag move together
  double farthest = 0;
  int mover = -1;
  for (const auto& [number, feature] : state.features) {
    const Scatter scatter = ScatterOf(feature);
    const int marker = feature.first.seen.marker;
    seen.insert(marker);
    if (scatter.is_noise || scatter.rms <= kAtRest * displacement) continue;
    moving.insert(marker);
    if (scatter.rms <= farthest) continue;
    farthest = scatter.rms;
    mover = marker;
  }
  // One alone among others is a wrong detection, which the fit rejects.
  if (moving.empty() || (moving.size() == 1 && seen.size() > 2)) return "";
  return fmt::format(
      "the body moves in {}: {} of {} markers scatter more than noise does, marker {} the most, by "
      "{:.3f} mm (standard deviation), beside displacements of {:.3f} mm. Known weights must hang "
      "at "
      "rest: give only the frames in which nothing moves any more, or single frames",
      NameOf(state), moving.size(), seen.size(), scene.markers.points[mover].id, 1e3 * farthest,
      1e3 * displacement);
}

std::vector<std::string> KnownStates::Moving(const scene::Scene& scene) const {
  std::vector<std::string> moving;
  for (const State& state : collected_) {
    const std::string movement = Movement(state, scene);
    if (!movement.empty()) moving.push_back(movement);
  }
  return moving;
}

std::string KnownStates::NameOf(const State& state) const {
  return state.frames == 1 ? fmt::format("frame {}", state.first_frame)
                           : fmt::format("frames {} to {}", state.first_frame, state.last_frame);
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
    state.name = NameOf(collected);
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
