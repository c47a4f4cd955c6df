#include "softforce/calibration/match_markers.h"

#include <algorithm>
#include <cmath>

#include "calibration/propose_poses.h"
#include "calibration/spot_points.h"
#include "softforce/base/input_error.h"
#include "softforce/camera/triangulate.h"

namespace softforce::calibration {
namespace {

constexpr double kFloor = 0.05;      // px; what a spot's covariance leaves out
constexpr int kMinMatched = 4;       // dots
constexpr int kMaxRounds = 4;        // of refining and looking again
constexpr double kClearlyWorse = 3;  // as often the misfit, and
constexpr double kWorseByPx = 0.2;   // that much more

// A proposal checked against all pictures.
struct Candidate {
  vision::RigPose pose;
  std::vector<std::vector<int>> spots;
  int matched = 0;

  // Whether it explains about as much as another one, or less but far better.
  bool Rivals(const Candidate& best, int min_lead) const {
    const bool alike = pose.rms_px < kClearlyWorse * best.pose.rms_px + kWorseByPx;
    const bool far_better = kClearlyWorse * pose.rms_px + kWorseByPx < best.pose.rms_px;
    return (matched > best.matched - min_lead && alike) ||
           (matched >= best.matched - min_lead && far_better);
  }
};

struct Expected {
  Eigen::Vector2d centroid, centre;  // px
  double diameter_px = 0, reach_px = 0;
};

class Matcher {
 public:
  Matcher(const camera::Rig& rig, const std::vector<KnownDot>& dots,
          const std::vector<std::vector<DetectedSpot>>& spots, const MatchOptions& options)
      : rig_(rig), dots_(dots), spots_(spots), options_(options) {}

  std::optional<Candidate> Check(const Proposal& proposal) const {
    Candidate candidate;
    candidate.pose.T_rig_robot = proposal.T_rig_robot;
    for (int round = 0; round < kMaxRounds; ++round) {
      std::vector<std::vector<int>> before = std::move(candidate.spots);
      candidate.spots = Assign(candidate.pose.T_rig_robot);
      if (candidate.spots == before) break;
      const auto sightings = Sightings(candidate.spots, candidate.pose.T_rig_robot);
      candidate.pose = vision::RefineRigPose(rig_, sightings, candidate.pose.T_rig_robot);
      if (!candidate.pose.ok()) return std::nullopt;
    }
    candidate.matched = SeenByTwo(candidate.spots);
    while (DropStranger(&candidate)) {
    }
    ShareErrors(&candidate);
    return candidate;
  }

  // m, mean distance between the dots as two poses have them.
  double Apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
    double sum = 0;
    for (const KnownDot& dot : dots_) sum += (a * dot.p_robot - b * dot.p_robot).norm();
    return sum / static_cast<double>(dots_.size());
  }

 private:
  std::optional<Expected> Expect(int camera, int dot, const Eigen::Isometry3d& T_rig_robot) const {
    const camera::Camera& seen_by = rig_.cameras[camera];
    const Eigen::Isometry3d T = seen_by.T_camera_rig * T_rig_robot;
    const Eigen::Vector3d p = T * dots_[dot].p_robot;
    const Eigen::Vector3d normal = T.linear() * dots_[dot].normal;
    if (!(p.z() > 0) || -normal.dot(p.normalized()) < options_.min_facing) return std::nullopt;
    const camera::Projection centre = camera::Project(seen_by.lens, p);
    const auto centroid = camera::ProjectDiscCentroid(seen_by.lens, p, normal, dots_[dot].diameter);
    if (!centre.visible || !centroid) return std::nullopt;
    const double px_per_m = seen_by.lens.fx / p.z();
    return Expected{*centroid, centre.pixel, dots_[dot].diameter * px_per_m,
                    options_.max_misfit_px + options_.max_misplacement * px_per_m};
  }

  bool SizeFits(const DetectedSpot& spot, const Expected& expected) const {
    if (!(spot.long_axis > 0)) return true;
    const double ratio = spot.long_axis / expected.diameter_px;
    return ratio < options_.size_tolerance && ratio > 1 / options_.size_tolerance;
  }

  // Pairs of dot and spot that are each other's nearest.
  std::vector<std::vector<int>> Assign(const Eigen::Isometry3d& T_rig_robot) const {
    std::vector<std::vector<int>> assigned(spots_.size(), std::vector<int>(dots_.size(), -1));
    for (int c = 0; c < static_cast<int>(spots_.size()); ++c) {
      std::vector<int> dot_of(spots_[c].size(), -1);
      std::vector<double> distance_of(spots_[c].size(), INFINITY);
      for (int d = 0; d < static_cast<int>(dots_.size()); ++d) {
        const auto expected = Expect(c, d, T_rig_robot);
        if (!expected) continue;
        int nearest = -1;
        double least = expected->reach_px;
        for (int s = 0; s < static_cast<int>(spots_[c].size()); ++s) {
          const double distance = (spots_[c][s].pixel - expected->centroid).norm();
          if (distance >= least || !SizeFits(spots_[c][s], *expected)) continue;
          nearest = s;
          least = distance;
        }
        if (nearest < 0 || least >= distance_of[nearest]) continue;
        if (dot_of[nearest] >= 0) assigned[c][dot_of[nearest]] = -1;
        dot_of[nearest] = d;
        distance_of[nearest] = least;
        assigned[c][d] = nearest;
      }
    }
    return assigned;
  }

  std::vector<vision::PointSighting> Sightings(const std::vector<std::vector<int>>& assigned,
                                               const Eigen::Isometry3d& T_rig_robot) const {
    std::vector<vision::PointSighting> sightings;
    for (int c = 0; c < static_cast<int>(assigned.size()); ++c) {
      for (int d = 0; d < static_cast<int>(dots_.size()); ++d) {
        if (assigned[c][d] < 0) continue;
        const Expected expected = *Expect(c, d, T_rig_robot);
        const DetectedSpot& spot = spots_[c][assigned[c][d]];
        sightings.push_back({dots_[d].p_robot, c,
                             spot.pixel - (expected.centroid - expected.centre),
                             spot.covariance + kFloor * kFloor * Eigen::Matrix2d::Identity()});
      }
    }
    return sightings;
  }

  int SeenByTwo(const std::vector<std::vector<int>>& assigned) const {
    int count = 0;
    for (size_t d = 0; d < dots_.size(); ++d) {
      int cameras = 0;
      for (const std::vector<int>& of_camera : assigned) cameras += of_camera[d] >= 0 ? 1 : 0;
      if (cameras >= 2) ++count;
    }
    return count;
  }

  // Near where a hidden dot should be there may be a spot that is none: without it all others fit
  // far better.
  bool DropStranger(Candidate* candidate) const {
    if (candidate->pose.rms_px <= kWorseByPx || candidate->matched <= kMinMatched) return false;
    Candidate best = *candidate;
    for (size_t d = 0; d < dots_.size(); ++d) {
      Candidate without = *candidate;
      for (std::vector<int>& of_camera : without.spots) of_camera[d] = -1;
      if (without.spots == candidate->spots) continue;
      const Eigen::Isometry3d& T = candidate->pose.T_rig_robot;
      without.pose = vision::RefineRigPose(rig_, Sightings(without.spots, T), T);
      if (without.pose.ok() && without.pose.rms_px < best.pose.rms_px) best = std::move(without);
    }
    if (kClearlyWorse * best.pose.rms_px > candidate->pose.rms_px) return false;
    best.matched = SeenByTwo(best.spots);
    if (best.matched < kMinMatched) return false;
    *candidate = std::move(best);
    return true;
  }

  // Misfit beyond the pictures' noise comes from dots that are painted elsewhere than listed, which
  // all cameras see alike: then a dot counts once, however many see it.
  void ShareErrors(Candidate* candidate) const {
    const auto sightings = Sightings(candidate->spots, candidate->pose.T_rig_robot);
    double expected = 0;
    for (const vision::PointSighting& seen : sightings) expected += seen.covariance.trace();
    const auto n = static_cast<double>(sightings.size());
    if (n == 0 || candidate->pose.rms_px < 1.3 * std::sqrt(expected / n)) return;
    int dots = 0;
    for (size_t d = 0; d < dots_.size(); ++d) {
      dots += std::any_of(candidate->spots.begin(), candidate->spots.end(),
                          [d](const std::vector<int>& of) { return of[d] >= 0; })
                  ? 1
                  : 0;
    }
    candidate->pose.covariance *= n / dots;
  }

  const camera::Rig& rig_;
  const std::vector<KnownDot>& dots_;
  const std::vector<std::vector<DetectedSpot>>& spots_;
  const MatchOptions& options_;
};

// Best first; one of those that put the dots at the same places.
std::vector<Candidate> Distinct(const Matcher& matcher, std::vector<Candidate> candidates,
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
const Candidate* Nearest(const Matcher& matcher, const std::vector<const Candidate*>& rivals,
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
      std::max(kMinMatched,
               static_cast<int>(std::ceil(options.min_share * static_cast<double>(dots.size()))));
  match.status = Status::kTooFewSeen;
  if (match.points < needed || static_cast<int>(dots.size()) < kMinMatched) return match;

  const Matcher matcher(rig, dots, spots, options);
  std::vector<Candidate> candidates;
  for (const Proposal& proposal : ProposePoses(rig, dots, points, options)) {
    const auto candidate = matcher.Check(proposal);
    if (candidate && candidate->matched >= kMinMatched) candidates.push_back(*candidate);
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
