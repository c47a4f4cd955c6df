#pragma once

#include <optional>
#include <vector>

#include "calibration/propose_poses.h"

namespace softforce::calibration {

inline constexpr int kMinMatchedDots = 4;

// A proposal checked against all pictures.
struct Candidate {
  vision::RigPose pose;
  std::vector<std::vector<int>> spots;  // as in MarkerMatch
  int matched = 0;

  // Whether it explains about as much as another one, or less but far better.
  bool Rivals(const Candidate& best, int min_lead) const;
};

// Lays dots onto the spots of all pictures. What it is made of must outlive it.
class DotMatcher {
 public:
  DotMatcher(const camera::Rig& rig, const std::vector<KnownDot>& dots,
             const std::vector<std::vector<DetectedSpot>>& spots, const MatchOptions& options)
      : rig_(rig), dots_(dots), spots_(spots), options_(options) {}

  // The proposal refined by all spots near where it has the dots; nothing if they fix no pose.
  std::optional<Candidate> Check(const Proposal& proposal) const;

  // m, mean distance between the dots as two poses have them.
  double Apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const;

 private:
  struct Expected {
    Eigen::Vector2d centroid, centre;  // px
    double diameter_px = 0, reach_px = 0;
  };
  using Spots = std::vector<std::vector<int>>;

  std::optional<Expected> Expect(int camera, int dot, const Eigen::Isometry3d& T_rig_robot) const;
  bool SizeFits(const DetectedSpot& spot, const Expected& expected) const;
  int NearestSpot(int camera, const Expected& expected) const;
  Spots Assign(const Eigen::Isometry3d& T_rig_robot) const;
  std::vector<vision::PointSighting> Sightings(const Spots& assigned,
                                               const Eigen::Isometry3d& T_rig_robot) const;
  int SeenBy(int cameras, const Spots& assigned) const;
  bool DropStranger(Candidate* candidate) const;
  void ShareErrors(Candidate* candidate) const;

  const camera::Rig& rig_;
  const std::vector<KnownDot>& dots_;
  const std::vector<std::vector<DetectedSpot>>& spots_;
  const MatchOptions& options_;
};

}  // namespace softforce::calibration
