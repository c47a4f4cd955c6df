#include "pipeline/registration.h"

#include <fmt/format.h>

#include <algorithm>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

constexpr double kMaxRegistrationRms = 3;  // px

}  // namespace

Detector::Detector(const scene::Scene& scene, const camera::Rig& rig) : scene_(scene), rig_(rig) {
  std::vector<std::string> families;
  if (scene.markers.type == scene::MarkerType::kAprilTag) families.push_back(scene.markers.family);
  for (const calibration::Fiducial& fiducial : scene.cameras.fiducials) {
    families.push_back(fiducial.family);
  }
  for (const std::string& family : families) {
    if (detectors_.count(family) == 0) detectors_.emplace(family, vision::TagDetector(family));
  }
}

const camera::Lens* Detector::LensOf(int c) const { return &rig_.cameras.at(c).lens; }

CameraDetections Detector::Markers(int c, const cv::Mat& picture) const {
  if (scene_.markers.type == scene::MarkerType::kDot) return {vision::DetectDots(picture), {}};
  return {{}, detectors_.at(scene_.markers.family).Detect(picture, LensOf(c))};
}

CameraDetections Detector::Markers(int c, const cv::Mat& picture, MarkerFollower* follower) const {
  if (scene_.markers.type == scene::MarkerType::kDot) return {follower->dots.Detect(picture), {}};
  return {{}, follower->tags.Detect(detectors_.at(scene_.markers.family), picture, LensOf(c))};
}

std::vector<CameraDetections> Detector::Markers(const vision::FrameSet& frame) const {
  std::vector<CameraDetections> cameras;
  cameras.reserve(frame.pictures.size());
  for (int c = 0; c < static_cast<int>(frame.pictures.size()); ++c) {
    cameras.push_back(Markers(c, frame.pictures[c]));
  }
  return cameras;
}

std::vector<vision::Tag> Detector::AllFiducials(int c, const cv::Mat& picture) const {
  std::vector<vision::Tag> all;
  std::vector<std::string> searched;
  for (const calibration::Fiducial& fiducial : scene_.cameras.fiducials) {
    if (std::find(searched.begin(), searched.end(), fiducial.family) != searched.end()) continue;
    searched.push_back(fiducial.family);
    const std::vector<vision::Tag> tags = detectors_.at(fiducial.family).Detect(picture, LensOf(c));
    all.insert(all.end(), tags.begin(), tags.end());
  }
  return all;
}

std::vector<std::vector<vision::Tag>> Detector::Fiducials(const vision::FrameSet& frame) const {
  std::vector<std::vector<vision::Tag>> cameras;
  cameras.reserve(frame.pictures.size());
  for (int c = 0; c < static_cast<int>(frame.pictures.size()); ++c) {
    cameras.push_back(AllFiducials(c, frame.pictures[c]));
  }
  return cameras;
}

std::vector<std::vector<vision::Tag>> Detector::FiducialsNear(
    const vision::FrameSet& frame, const std::vector<CameraDetections>& markers,
    const std::vector<std::vector<FiducialPlace>>& places) const {
  std::vector<std::vector<vision::Tag>> cameras(frame.pictures.size());
  for (int c = 0; c < static_cast<int>(cameras.size()); ++c) {
    for (const FiducialPlace& place : places[c]) {
      const calibration::Fiducial& fiducial = scene_.cameras.fiducials[place.fiducial];
      const bool among_markers = scene_.markers.type == scene::MarkerType::kAprilTag &&
                                 scene_.markers.family == fiducial.family;
      std::vector<vision::Tag> tags = among_markers
                                          ? markers[c].tags
                                          : detectors_.at(fiducial.family)
                                                .DetectIn(frame.pictures[c], place.area,
                                                          vision::TagOptions().decimate, LensOf(c));
      for (vision::Tag& tag : tags) {
        if (tag.id != fiducial.id) continue;
        cameras[c].push_back(std::move(tag));
      }
    }
    if (2 * cameras[c].size() < places[c].size()) cameras[c] = AllFiducials(c, frame.pictures[c]);
  }
  return cameras;
}

ShowFirstFrames FirstFramesOf(vision::Recording* recording, int frames) {
  return [recording, frames](const std::function<void(const vision::FrameSet&)>& look) {
    for (int i = 0; i < frames; ++i) {
      const std::optional<vision::FrameSet> frame = recording->Next();
      if (!frame) break;
      look(*frame);
    }
    recording->Rewind();
  };
}

Eigen::Matrix3d PointCovariance(const Eigen::Isometry3d& T_rig_robot,
                                const geometry::Matrix6d& covariance,
                                const Eigen::Vector3d& p_robot) {
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(), -geometry::Skew(T_rig_robot * p_robot);
  return J * covariance * J.transpose();
}

Standing FindRig(const scene::Scene& scene, const camera::Rig& rig, const Detector& detector,
                 const ShowFirstFrames& show) {
  if (scene.cameras.fiducials.empty()) {
    if (rig.T_rig_robot)
      return {*rig.T_rig_robot, rig.T_rig_robot_covariance, std::nullopt, {}, "rig_file"};
    throw base::InputError(
        scene.file.string() + ": cameras",
        "nothing says where the cameras stand: there are no fiducials here and no T_rig_robot in " +
            scene.cameras.rig.string(),
        "Find it with softforce register, or fix AprilTags to the robot's base and list their "
        "corners under 'fiducials'.");
  }
  calibration::FiducialRegistration registration(rig, scene.cameras.fiducials);
  int frames = 0;
  show([&](const vision::FrameSet& frame) {
    registration.Add(detector.Fiducials(frame));
    ++frames;
  });
  const vision::RigPose pose = registration.Solve();
  if (!pose.ok()) {
    throw base::InputError(scene.file.string() + ": cameras: fiducials",
                           fmt::format("the rig's place cannot be found from them: {} corners were "
                                       "seen in the first {} frames",
                                       pose.num_points, frames),
                           "At least one fiducial must be sharp and wholly in view of a camera; "
                           "check family, id and corners.");
  }
  if (pose.rms_px > kMaxRegistrationRms) {
    throw base::InputError(scene.file.string() + ": cameras: fiducials",
                           fmt::format("their corners are seen {:.1f} px off where rig and "
                                       "fiducials put them; at most {} px can be "
                                       "explained by noise",
                                       pose.rms_px, kMaxRegistrationRms),
                           "Check the corners' places and order (TL TR BR BL), and that rig.yaml "
                           "belongs to these cameras.");
  }
  return {pose.T_rig_robot, pose.covariance, pose, registration.Means(), "fiducials"};
}

}  // namespace softforce::pipeline
