#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/rig_pose.h"
#include "softforce/vision/tags.h"

namespace softforce::calibration {

// A tag fixed to the robot's base.
struct Fiducial {
  std::string family = "tag36h11";
  int id = -1;
  std::array<Eigen::Vector3d, 4>
      corners;  // m, robot frame; TL TR BR BL of the upright tag's black square
};

// Where a camera sees a fiducial, averaged over frames.
struct MeanTag {
  int camera = -1, fiducial = -1, count = 0;
  std::array<Eigen::Vector2d, 4> corners;      // px
  std::array<Eigen::Matrix2d, 4> covariances;  // px², of the corners of a single frame
};

// Collects sightings of base fiducials over frames of a rig that stands still, and finds where it
// stands. The corners of a tag are averaged over the frames, which takes away the pictures' noise
// but not what is the same in all (lens model, print), so a floor is kept under the averaged
// covariance.
class FiducialRegistration {
 public:
  FiducialRegistration(const camera::Rig& rig, std::vector<Fiducial> fiducials);

  // `tags_of_camera[c]`: all tags seen by camera c in one frame; unknown ids are ignored.
  void Add(const std::vector<std::vector<vision::Tag>>& tags_of_camera);

  // The families that its fiducials belong to.
  std::vector<std::string> Families() const;

  int num_sightings() const;

  std::vector<MeanTag> Means() const;

  // Status kTooFewPoints if no fiducial was seen. If the corners fit badly as given and all tags
  // turned alike by quarter turns fit well, the tags are taken to be mounted that way.
  vision::RigPose Solve() const;

 private:
  struct CornerMean {
    int camera = -1, fiducial = -1, count = 0;
    std::array<Eigen::Vector2d, 4> sum;
    std::array<Eigen::Matrix2d, 4> covariance_sum;
  };

  vision::RigPose SolveTurned(int quarter_turns) const;
  void AddTag(int camera, int fiducial, const vision::Tag& tag);

  const camera::Rig& rig_;
  std::vector<Fiducial> fiducials_;
  std::vector<CornerMean> means_;
};

}  // namespace softforce::calibration
