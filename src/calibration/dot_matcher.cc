#include "calibration/dot_matcher.h"

#include <algorithm>
#include <cmath>

#include "softforce/camera/lens.h"

namespace softforce::calibration {
namespace {

constexpr double kFloor = 0.05;       // px; what a spot's covariance leaves out
constexpr int kMaxRounds = 4;         // of refining and looking again
constexpr double kClearlyWorse = 3;   // as often the misfit, and
constexpr double kWorseByPx = 0.2;    // that much more
constexpr double kBeyondNoise = 1.3;  // as often the misfit that noise explains

}  // namespace

bool Candidate::Rivals(const Candidate& best, int min_lead) const {
  const bool alike = pose.rms_px < kClearlyWorse * best.pose.rms_px + kWorseByPx;
  const bool far_better = kClearlyWorse * pose.rms_px + kWorseByPx < best.pose.rms_px;
  return (matched > best.matched - min_lead && alike) ||
         (matched >= best.matched - min_lead && far_better);
}

std::optional<Candidate> DotMatcher::Check(const Proposal& proposal) const {
  Candidate candidate;
  candidate.pose.T_rig_robot = proposal.T_rig_robot;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Spots before = std::move(candidate.spots);
    candidate.spots = Assign(candidate.pose.T_rig_robot);
    if (candidate.spots == before) break;
    const auto sightings = Sightings(candidate.spots, candidate.pose.T_rig_robot);
    candidate.pose = vision::RefineRigPose(rig_, sightings, candidate.pose.T_rig_robot);
    if (!candidate.pose.ok()) return std::nullopt;
  }
  candidate.matched = SeenBy(2, candidate.spots);
  while (DropStranger(&candidate)) {
  }
  ShareErrors(&candidate);
  return candidate;
}

double DotMatcher::Apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
  double sum = 0;
  for (const KnownDot& dot : dots_) sum += (a * dot.p_robot - b * dot.p_robot).norm();
  return sum / static_cast<double>(dots_.size());
}

std::optional<DotMatcher::Expected> DotMatcher::Expect(int camera, int dot,
                                                       const Eigen::Isometry3d& T_rig_robot) const {
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

bool DotMatcher::SizeFits(const DetectedSpot& spot, const Expected& expected) const {
  if (!(spot.long_axis > 0)) return true;
  const double ratio = spot.long_axis / expected.diameter_px;
  return ratio < options_.size_tolerance && ratio > 1 / options_.size_tolerance;
}

// −1: none is near enough.
int DotMatcher::NearestSpot(int camera, const Expected& expected) const {
  int nearest = -1;
  double least = expected.reach_px;
  for (int s = 0; s < static_cast<int>(spots_[camera].size()); ++s) {
    const double distance = (spots_[camera][s].pixel - expected.centroid).norm();
    if (distance >= least || !SizeFits(spots_[camera][s], expected)) continue;
    nearest = s;
    least = distance;
  }
  return nearest;
}

// Pairs of dot and spot that are each other's nearest.
DotMatcher::Spots DotMatcher::Assign(const Eigen::Isometry3d& T_rig_robot) const {
  Spots assigned(spots_.size(), std::vector<int>(dots_.size(), -1));
  for (int c = 0; c < static_cast<int>(spots_.size()); ++c) {
    std::vector<int> dot_of(spots_[c].size(), -1);
    std::vector<double> distance_of(spots_[c].size(), INFINITY);
    for (int d = 0; d < static_cast<int>(dots_.size()); ++d) {
      const auto expected = Expect(c, d, T_rig_robot);
      const int nearest = expected ? NearestSpot(c, *expected) : -1;
      if (nearest < 0) continue;
      const double distance = (spots_[c][nearest].pixel - expected->centroid).norm();
      if (distance >= distance_of[nearest]) continue;
      if (dot_of[nearest] >= 0) assigned[c][dot_of[nearest]] = -1;
      dot_of[nearest] = d;
      distance_of[nearest] = distance;
      assigned[c][d] = nearest;
    }
  }
  return assigned;
}

std::vector<vision::PointSighting> DotMatcher::Sightings(
    const Spots& assigned, const Eigen::Isometry3d& T_rig_robot) const {
  std::vector<vision::PointSighting> sightings;
  for (int c = 0; c < static_cast<int>(assigned.size()); ++c) {
    for (int d = 0; d < static_cast<int>(dots_.size()); ++d) {
      if (assigned[c][d] < 0) continue;
      // A refined pose may have turned a dot away that was assigned before.
      const auto expected = Expect(c, d, T_rig_robot);
      if (!expected) continue;
      const DetectedSpot& spot = spots_[c][assigned[c][d]];
      sightings.push_back({dots_[d].p_robot, c,
                           spot.pixel - (expected->centroid - expected->centre),
                           spot.covariance + kFloor * kFloor * Eigen::Matrix2d::Identity()});
    }
  }
  return sightings;
}

// Dots that so many cameras see, or more.
int DotMatcher::SeenBy(int cameras, const Spots& assigned) const {
  int count = 0;
  for (size_t d = 0; d < dots_.size(); ++d) {
    const auto seen = std::count_if(assigned.begin(), assigned.end(),
                                    [d](const std::vector<int>& of) { return of[d] >= 0; });
    if (seen >= cameras) ++count;
  }
  return count;
}

// Near where a hidden dot should be there may be a spot that is none: without it all others fit
// far better.
bool DotMatcher::DropStranger(Candidate* candidate) const {
  if (candidate->pose.rms_px <= kWorseByPx || candidate->matched <= kMinMatchedDots) return false;
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
  best.matched = SeenBy(2, best.spots);
  if (best.matched < kMinMatchedDots) return false;
  *candidate = std::move(best);
  return true;
}

// Misfit beyond the pictures' noise comes from dots that are painted elsewhere than listed, which
// all cameras see alike: then a dot counts once, however many see it.
void DotMatcher::ShareErrors(Candidate* candidate) const {
  const auto sightings = Sightings(candidate->spots, candidate->pose.T_rig_robot);
  double expected = 0;
  for (const vision::PointSighting& seen : sightings) expected += seen.covariance.trace();
  const auto n = static_cast<double>(sightings.size());
  if (n == 0 || candidate->pose.rms_px < kBeyondNoise * std::sqrt(expected / n)) return;
  candidate->pose.covariance *= n / SeenBy(1, candidate->spots);
}

}  // namespace softforce::calibration
