#pragma once

#include <functional>

#include "softforce/pipeline/run.h"
#include "softforce/vision/dot_follower.h"
#include "softforce/vision/recording.h"
#include "softforce/vision/rig_pose.h"
#include "softforce/vision/tag_follower.h"

namespace softforce::pipeline {

// Follows the markers of one camera from picture to picture.
struct MarkerFollower {
  vision::TagFollower tags;
  vision::DotFollower dots;
};

// Detects what a scene's markers and fiducials need in pictures; for one thread.
class Detector {
 public:
  // Both must outlive it.
  Detector(const scene::Scene& scene, const camera::Rig& rig);

  // What camera c sees.
  CameraDetections Markers(int c, const cv::Mat& picture) const;
  // The same, where `follower` was shown the pictures before.
  CameraDetections Markers(int c, const cv::Mat& picture, MarkerFollower* follower) const;
  std::vector<CameraDetections> Markers(const vision::FrameSet& frame) const;
  std::vector<std::vector<vision::Tag>> Fiducials(const vision::FrameSet& frame) const;

  // The same, looking first only around where they were: `places[camera]` are the fiducials that
  // the camera saw and the parts of its picture to search. Where it finds fewer than half of them
  // there it searches all of the picture. `markers`: what was already found in the frame.
  struct FiducialPlace {
    int fiducial = -1;
    cv::Rect area;
  };
  std::vector<std::vector<vision::Tag>> FiducialsNear(
      const vision::FrameSet& frame, const std::vector<CameraDetections>& markers,
      const std::vector<std::vector<FiducialPlace>>& places) const;

 private:
  const camera::Lens* LensOf(int c) const;
  std::vector<vision::Tag> AllFiducials(int c, const cv::Mat& picture) const;

  const scene::Scene& scene_;
  const camera::Rig& rig_;
  std::map<std::string, vision::TagDetector> detectors_;  // by family
};

// Shows the first frames of a source, one after another.
using ShowFirstFrames = std::function<void(const std::function<void(const vision::FrameSet&)>&)>;

// Those of a recording, which is rewound after.
ShowFirstFrames FirstFramesOf(vision::Recording* recording, int frames);

// Where the rig stands: from the base fiducials in the first frames; or, for a scene without
// fiducials, as the rig's file says. Throws InputError if neither works.
struct Standing {
  Eigen::Isometry3d T_rig_robot;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  // see vision::RigPose
  std::optional<vision::RigPose> from_fiducials;
  std::vector<calibration::MeanTag> fiducials;  // as the cameras saw them
  std::string from = "rig_file";                // what told it, if not fiducials
};
Standing FindRig(const scene::Scene& scene, const camera::Rig& rig, const Detector& detector,
                 const ShowFirstFrames& show);

// m², rig's axes: of a point that is fixed to the robot, by how sure it is where the rig stands.
Eigen::Matrix3d PointCovariance(const Eigen::Isometry3d& T_rig_robot,
                                const geometry::Matrix6d& covariance,
                                const Eigen::Vector3d& p_robot);

}  // namespace softforce::pipeline
