// Which force is which, from frame to frame.
#include <algorithm>
#include <set>

#include "estimation/location_state.h"

namespace softforce::estimation {
namespace {

constexpr double kFarthest = 0.2;  // diagonals: one that jumps further is another force
constexpr double kReturn = 0.1;    // diagonals: one that was gone comes back no further off
constexpr int kRemembered = 15;    // frames that it may be gone

}  // namespace

// One that is there goes on being itself, even where another one was before.
void LocationEstimator::State::Identify(const std::vector<TrialForce>& before,
                                        const std::vector<GoneForce>& vanished,
                                        std::vector<TrialForce>* trials) {
  struct Pair {
    double apart;  // m
    int identity;
    TrialForce* trial;
    bool operator<(const Pair& other) const { return apart < other.apart; }
  };
  std::vector<Pair> present, returning;
  for (TrialForce& trial : *trials) {
    trial.identity = -1;
    const Eigen::Vector3d place = faces.walk().Position(trial.at);
    for (const TrialForce& old : before) {
      const double apart = (faces.walk().Position(old.at) - place).norm();
      if (apart <= kFarthest * diagonal) present.push_back({apart, old.identity, &trial});
    }
    for (const GoneForce& old : vanished) {
      const double apart = (old.rest - place).norm();
      if (apart <= kReturn * diagonal) returning.push_back({apart, old.identity, &trial});
    }
  }
  std::set<int> taken;
  for (std::vector<Pair>* pairs : {&present, &returning}) {
    std::sort(pairs->begin(), pairs->end());
    for (const Pair& pair : *pairs) {
      if (pair.trial->identity >= 0 || !taken.insert(pair.identity).second) continue;
      pair.trial->identity = pair.identity;
    }
  }
  for (TrialForce& trial : *trials) {
    if (trial.identity < 0) trial.identity = next_identity++;
  }
}

void LocationEstimator::State::Remember(const std::vector<TrialForce>& now) {
  for (GoneForce& force : gone) ++force.frames;
  for (const TrialForce& force : forces) {
    gone.push_back({force.identity, faces.walk().Position(force.at), 1});
  }
  const auto is_over = [&now](const GoneForce& force) {
    const bool acts = std::any_of(now.begin(), now.end(), [&](const TrialForce& one) {
      return one.identity == force.identity;
    });
    return acts || force.frames > kRemembered;
  };
  gone.erase(std::remove_if(gone.begin(), gone.end(), is_over), gone.end());
  forces = now;
}

}  // namespace softforce::estimation
