#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "softforce/estimation/identification.h"
#include "softforce/pipeline/known_weights.h"
#include "softforce/pipeline/tracker.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// Collects what was seen in frames with known forces. Frames of one spec under the same actuation
// become one state, in which each feature is where it was on average. Its covariance stays that of
// a single frame: print, lens and compression are the same in all of them, and a run weighs single
// frames, too.
class KnownStates {
 public:
  // All must outlive it.
  KnownStates(const scene::Scene& scene, const World& world,
              const std::vector<KnownWeights>& weights);

  bool Wants(int frame) const;
  int end_frame() const;  // one past the last that it wants

  void Add(int frame, const fem::Actuation& actuation,
           const std::vector<MarkerObservation>& observations);

  // What to tell people of states in which the body moves, between frames that are averaged, by
  // more than the noise and a small part of its displacement. Empty if it is at rest in all.
  std::vector<std::string> Moving(const scene::Scene& scene) const;

  std::vector<estimation::KnownState> Collected() const;
  const KnownWeights& WeightsOf(int state) const { return weights_[collected_[state].spec]; }

 private:
  struct Feature {
    MarkerObservation first;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // sum over frames, 1/m²
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();     // sum of information · position
    std::vector<estimation::Observation> all;               // frame by frame
    int frames = 0;
  };
  // How far a feature is from its mean, over frames.
  struct Scatter {
    double rms = 0;           // m, standard deviation of its distance
    double displacement = 0;  // m, of the mean from the place at rest
    bool is_noise = true;     // the noise alone could have made it
  };
  struct State {
    int spec = 0;
    int first_frame = 0, last_frame = 0, frames = 0;
    fem::Actuation actuation;  // of the first frame
    std::map<int, Feature> features;
  };

  bool SameActuation(const fem::Actuation& a, const fem::Actuation& b) const;
  estimation::Observation Mean(const Feature& feature) const;
  Scatter ScatterOf(const Feature& feature) const;
  double Displacement(const State& state) const;  // m, the largest of a feature
  std::string NameOf(const State& state) const;
  std::string Movement(const State& state, const scene::Scene& scene) const;  // empty: none
  Eigen::Matrix3Xd Forces(const KnownWeights& weights) const;

  const World& world_;
  const std::vector<KnownWeights>& weights_;
  Eigen::VectorXd tolerance_;  // of each command: cables, then chambers
  std::vector<State> collected_;
};

}  // namespace softforce::pipeline
