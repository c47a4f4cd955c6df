#pragma once

#include <map>
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

  std::vector<estimation::KnownState> Collected() const;
  const KnownWeights& WeightsOf(int state) const { return weights_[collected_[state].spec]; }

 private:
  struct Feature {
    MarkerObservation first;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // sum over frames, 1/m²
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();     // sum of information · position
    int frames = 0;
  };
  struct State {
    int spec = 0;
    int first_frame = 0, last_frame = 0, frames = 0;
    fem::Actuation actuation;  // of the first frame
    std::map<int, Feature> features;
  };

  bool SameActuation(const fem::Actuation& a, const fem::Actuation& b) const;
  estimation::Observation Mean(const Feature& feature) const;
  Eigen::Matrix3Xd Forces(const KnownWeights& weights) const;

  const World& world_;
  const std::vector<KnownWeights>& weights_;
  Eigen::VectorXd tolerance_;  // of each command: cables, then chambers
  std::vector<State> collected_;
};

}  // namespace softforce::pipeline
