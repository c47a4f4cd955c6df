#include "softforce/calibration/match_markers.h"

#include <algorithm>
#include <cmath>

#include "calibration/dot_matcher.h"
#include "calibration/spot_points.h"
#include "softforce/base/input_error.h"

namespace softforce::calibration {
namespace {

// Best first; one of those that put the dots at the same places.
std::vector<Candidate> Distinct(const DotMatcher& matcher, std::vector<Candidate> candidates,
                                const MatchOptions& options) {
  std::stable_sort(
      candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.matched != b.matched ? a.matched > b.matched : a.pose.rms_px < b.pose.rms_px;
      });
  std::vector<Candidate> distinct;
  for (Candidate& candidate : candidates) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const Candidate& other) {
      return matcher.Apart(candidate.pose.T_rig_robot, other.pose.T_rig_robot) <
             2 * options.max_misplacement;
    });
    if (!known) distinct.push_back(std::move(candidate));
  }
  return distinct;
}

// The one of several that is clearly nearest to the guess by some measure.
template <class Distance>
const Candidate* ClearlyNearest(const std::vector<const Candidate*>& rivals, Distance distance) {
  const Candidate* nearest = nullptr;
  double least = INFINITY, second = INFINITY;
  for (const Candidate* rival : rivals) {
    const double apart = distance(rival->pose.T_rig_robot);
    if (apart < least) {
      second = least;
      least = apart;
      nearest = rival;
    } else {
      second = std::min(second, apart);
    }
  }
  return 2 * least < second ? nearest : nullptr;
}

// By how the dots are turned, which is often known better than where they are; or by where they
// are, if their turn does not speak against it.
const Candidate* Nearest(const DotMatcher& matcher, const std::vector<const Candidate*>& rivals,
                         const Eigen::Isometry3d& guess) {
  const auto turn = [&](const Eigen::Isometry3d& T) {
    return Eigen::AngleAxisd(T.linear().transpose() * guess.linear()).angle();
  };
  const Candidate* by_place =
      ClearlyNearest(rivals, [&](const Eigen::Isometry3d& T) { return matcher.Apart(T, guess); });
  const Candidate* by_turn = ClearlyNearest(rivals, turn);
  if (by_turn != nullptr) return by_place == nullptr || by_place == by_turn ? by_turn : nullptr;
  if (by_place == nullptr) return nullptr;
  double least_turn = INFINITY;
  for (const Candidate* rival : rivals) {
    least_turn = std::min(least_turn, turn(rival->pose.T_rig_robot));
  }
  constexpr double kAsWell = 0.03;  // rad
  return turn(by_place->pose.T_rig_robot) < least_turn + kAsWell ? by_place : nullptr;
}

}  // namespace

void MatchOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("match option ") + option, rule);
  };
  require(max_misplacement > 0, "max_misplacement", "must be greater than 0 m");
  require(max_misfit_px > 0, "max_misfit_px", "must be greater than 0 px");
  require(size_tolerance > 1, "size_tolerance", "must be greater than 1");
  require(min_facing >= 0 && min_facing < 1, "min_facing", "must be at least 0 and below 1");
  require(min_share > 0 && min_share <= 1, "min_share", "must be above 0 and at most 1");
  require(min_lead >= 1, "min_lead", "must be 1 or more");
  require(max_triples >= 1, "max_triples", "must be 1 or more");
}

MarkerMatch MatchMarkers(const camera::Rig& rig, const std::vector<KnownDot>& dots,
                         const std::vector<std::vector<DetectedSpot>>& spots,
                         const std::optional<Eigen::Isometry3d>& guess,
                         const MatchOptions& options) {
  using Status = MarkerMatch::Status;
  options.Check();
  MarkerMatch match;
  const std::vector<Eigen::Vector3d> points = PointsOfSpots(rig, spots, options);
  match.points = static_cast<int>(points.size());
  const int needed =
      std::max(kMinMatchedDots,
               static_cast<int>(std::ceil(options.min_share * static_cast<double>(dots.size()))));
  match.status = Status::kTooFewSeen;
  if (match.points < needed || static_cast<int>(dots.size()) < kMinMatchedDots) return match;

  const DotMatcher matcher(rig, dots, spots, options);
  std::vector<Candidate> candidates;
  for (const Proposal& proposal : ProposePoses(rig, dots, points, options)) {
    const auto candidate = matcher.Check(proposal);
    if (candidate && candidate->matched >= kMinMatchedDots) candidates.push_back(*candidate);
  }
  candidates = Distinct(matcher, std::move(candidates), options);
  match.status = Status::kNoMatch;
  if (candidates.empty()) return match;
  const Candidate* best = &candidates.front();
  match.matched = best->matched;
  if (best->matched < needed) return match;

  std::vector<const Candidate*> rivals{best};
  for (const Candidate& other : candidates) {
    if (&other == best) continue;
    match.rival = std::max(match.rival, other.matched);
    if (other.Rivals(*best, options.min_lead)) rivals.push_back(&other);
  }
  if (rivals.size() > 1) {
    match.status = Status::kAmbiguous;
    best = guess ? Nearest(matcher, rivals, *guess) : nullptr;
    if (best == nullptr) return match;
    match.by_guess = true;
    match.matched = best->matched;
  }
  match.status = Status::kOk;
  match.pose = best->pose;
  match.spots = best->spots;
  return match;
}

}  // namespace softforce::calibration
