#include "pipeline/rig_watch.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "softforce/geometry/chi_square.h"

namespace softforce::pipeline {
namespace {

constexpr double kFalseAlarm = 1e-6;  // probability, of one fiducial in one frame
constexpr double kFloor = 0.05;       // px; what differs from frame to frame besides noise
constexpr double kMinShift = 0.25;    // px; less is not worth an interruption
constexpr int kConfirm = 3;           // frames in a row
constexpr int kAlone = 10;            // frames in a row that a single fiducial must be off
constexpr double kRigidRms = 0.5;     // px; or so many times that of the first registration:
constexpr double kRigidShare = 3;
constexpr double kAreaMargin = 0.6;  // of a fiducial's size in the picture, on every side
constexpr int kMinMargin = 24;       // px

// px, root mean square over the corners.
double Shift(const std::array<Eigen::Vector2d, 4>& a, const std::array<Eigen::Vector2d, 4>& b) {
  double square = 0;
  for (int i = 0; i < 4; ++i) square += (a[i] - b[i]).squaredNorm() / 4;
  return std::sqrt(square);
}

// How far a body's centre moves in the rig, and how much it turns.
std::string Motion(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after) {
  const Eigen::Isometry3d motion = after * before.inverse();
  // Of the cameras against the robot, in their own frame.
  return fmt::format("{:.2f} mm and {:.2f} degrees", 1e3 * motion.inverse().translation().norm(),
                     Eigen::AngleAxisd(motion.linear()).angle() * 180 / M_PI);
}

}  // namespace

const char* Name(RigEvent::Kind kind) {
  switch (kind) {
    case RigEvent::Kind::kBumped:
      return "bumped";
    case RigEvent::Kind::kCamerasMoved:
      return "cameras_moved";
    case RigEvent::Kind::kFiducialMoved:
      return "fiducial_moved";
    case RigEvent::Kind::kPerhapsBumped:
      return "perhaps_bumped";
    case RigEvent::Kind::kBack:
      return "back";
  }
  return "";
}

RigWatch::RigWatch(const scene::Scene& scene, const camera::Rig& rig, const Standing& standing,
                   int frames, Tell tell)
    : scene_(scene),
      rig_(rig),
      standing_(standing),
      frames_(std::max(frames, kConfirm)),
      tell_(std::move(tell)),
      off_alone_(scene.cameras.fiducials.size(), 0) {
  SetPlaces();
}

void RigWatch::SetPlaces() {
  places_.resize(rig_.cameras.size());
  for (const calibration::MeanTag& tag : standing_.fiducials) {
    Eigen::Vector2d low = tag.corners[0], high = tag.corners[0];
    for (const Eigen::Vector2d& corner : tag.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const double margin = std::max<double>(kMinMargin, kAreaMargin * (high - low).maxCoeff());
    const cv::Rect picture(0, 0, rig_.cameras[tag.camera].width, rig_.cameras[tag.camera].height);
    const cv::Point from(static_cast<int>(low.x() - margin), static_cast<int>(low.y() - margin));
    const cv::Point to(static_cast<int>(high.x() + margin), static_cast<int>(high.y() + margin));
    places_[tag.camera].push_back({tag.fiducial, cv::Rect(from, to) & picture});
  }
}

void RigWatch::Report(RigEvent event) {
  if (tell_) tell_(event.text);
  events_.push_back(std::move(event));
}

std::vector<RigWatch::Sighting> RigWatch::Compare(const Tags& fiducials) const {
  const double limit = geometry::ChiSquareQuantile(1 - kFalseAlarm, 8);
  std::vector<Sighting> seen;
  for (const calibration::MeanTag& reference : standing_.fiducials) {
    const calibration::Fiducial& fiducial = scene_.cameras.fiducials[reference.fiducial];
    const vision::Tag* found = nullptr;
    int times = 0;
    for (const vision::Tag& tag : fiducials[reference.camera]) {
      if (tag.id != fiducial.id || tag.family != fiducial.family) continue;
      found = &tag;
      ++times;
    }
    if (times != 1) continue;  // of two alike one is a stray
    double chi2 = 0;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Matrix2d covariance = found->corner_covariances[i] +
                                         reference.covariances[i] / reference.count +
                                         kFloor * kFloor * Eigen::Matrix2d::Identity();
      const Eigen::Vector2d shift = found->corners[i] - reference.corners[i];
      chi2 += shift.dot(covariance.inverse() * shift);
    }
    const double shift_px = Shift(found->corners, reference.corners);
    seen.push_back({&reference, found, shift_px, shift_px > kMinShift && chi2 > limit});
  }
  return seen;
}

// Most of all fiducials are off, or most of several that one camera sees. One alone may be covered
// in part, or have been knocked.
bool RigWatch::IsOff(const std::vector<Sighting>& seen) const {
  const int num_cameras = static_cast<int>(rig_.cameras.size());
  int all = 0, all_off = 0;
  for (int c = 0; c < num_cameras; ++c) {
    int count = 0, off = 0;
    for (const Sighting& sighting : seen) {
      if (sighting.reference->camera != c) continue;
      ++count;
      off += sighting.off ? 1 : 0;
    }
    if (count > 1 && 2 * off > count) return true;
    all += count;
    all_off += off;
  }
  return 2 * all_off > all;
}

RigWatch::Verdict RigWatch::Look(int frame, const Tags& fiducials) {
  Verdict verdict;
  const std::string pending = "the rig may have been bumped: its fiducials are not where they were";
  const std::string lost =
      "the cameras have moved against each other: the rig file does not hold any more";
  saw_fiducials_ = false;
  if (given_up_) return {false, lost, false};
  if (fiducials.empty() || standing_.fiducials.empty()) {
    return suspected_since_ < 0 ? verdict : Verdict{false, pending, false};
  }
  const std::vector<Sighting> seen = Compare(fiducials);
  saw_fiducials_ = !seen.empty();
  if (IsOff(seen)) {
    double shift = 0;
    for (const Sighting& sighting : seen) shift = std::max(shift, sighting.shift_px);
    verdict = Suspect(frame, fiducials, shift);
    if (given_up_) verdict.reason = lost;
    return verdict;
  }
  if (seen.empty()) return suspected_since_ < 0 ? verdict : Verdict{false, pending, false};
  suspected_since_ = -1;  // it was a passing matter
  suspicious_.clear();
  WatchSingleFiducials(frame, seen);
  if (improving_) {
    Improve(fiducials);
    verdict.placed_anew = true;
  }
  return verdict;
}

void RigWatch::WatchSingleFiducials(int frame, const std::vector<Sighting>& seen) {
  for (int f = 0; f < static_cast<int>(off_alone_.size()); ++f) {
    bool off = false;
    for (const Sighting& sighting : seen) off |= sighting.reference->fiducial == f && sighting.off;
    off_alone_[f] = off ? off_alone_[f] + 1 : 0;
    if (off_alone_[f] < kAlone) continue;
    off_alone_[f] = 0;
    auto& known = standing_.fiducials;
    known.erase(std::remove_if(known.begin(), known.end(),
                               [f](const calibration::MeanTag& tag) { return tag.fiducial == f; }),
                known.end());
    RigEvent event;
    event.kind = RigEvent::Kind::kFiducialMoved;
    event.frame = frame - kAlone + 1;
    event.told = frame;
    event.text = fmt::format(
        "frame {}: fiducial {} has moved while the others stand still; it is not used any more",
        event.frame, scene_.cameras.fiducials[f].id);
    Report(event);
    return;  // the sightings refer to what was just changed
  }
}

// Against the last suspicious frame.
bool RigWatch::StandsStill(const Tags& fiducials) const {
  if (suspicious_.empty()) return true;
  for (size_t c = 0; c < fiducials.size(); ++c) {
    for (const vision::Tag& tag : fiducials[c]) {
      for (const vision::Tag& before : suspicious_.back()[c]) {
        const bool same = tag.id == before.id && tag.family == before.family;
        if (same && Shift(tag.corners, before.corners) > kMinShift) return false;
      }
    }
  }
  return true;
}

RigWatch::Verdict RigWatch::Suspect(int frame, const Tags& fiducials, double shift_px) {
  if (suspected_since_ < 0) suspected_since_ = frame;
  improving_.reset();
  if (!StandsStill(fiducials)) suspicious_.clear();
  suspicious_.push_back(fiducials);
  if (static_cast<int>(suspicious_.size()) >= kConfirm) return PlaceAnew(frame, shift_px);
  return {false,
          fmt::format("the rig may have been bumped: its fiducials are up to {:.1f} px from where "
                      "they were",
                      shift_px),
          false};
}

RigWatch::Verdict RigWatch::PlaceAnew(int frame, double shift_px) {
  calibration::FiducialRegistration registration(rig_, scene_.cameras.fiducials);
  for (const Tags& tags : suspicious_) registration.Add(tags);
  const vision::RigPose pose = registration.Solve();
  const double before = standing_.from_fiducials ? standing_.from_fiducials->rms_px : 0;
  RigEvent event;
  event.frame = suspected_since_;
  event.told = frame;
  if (!pose.ok() || pose.rms_px > std::max(kRigidRms, kRigidShare * before)) {
    given_up_ = true;
    event.kind = RigEvent::Kind::kCamerasMoved;
    event.text = fmt::format(
        "frame {}: the cameras have moved against each other: fiducials are up to {:.1f} px from "
        "where they were, and no place of the rig explains it; there are no forces from here on. "
        "Calibrate the rig anew",
        event.frame, shift_px);
    Report(event);
    return {false, "", false};
  }
  event.pose = pose;
  event.text = fmt::format(
      "frame {}: the rig was bumped, by {} at its first camera; it is placed anew from frame {} "
      "on, "
      "by {} corners which fit to {:.3f} px",
      event.frame, Motion(standing_.T_rig_robot, pose.T_rig_robot), frame, pose.num_points,
      pose.rms_px);
  standing_ = {pose.T_rig_robot, pose.covariance, pose, registration.Means()};
  improving_.emplace(std::move(registration));
  improved_by_ = static_cast<int>(suspicious_.size());
  suspected_since_ = -1;
  suspicious_.clear();
  std::fill(off_alone_.begin(), off_alone_.end(), 0);
  Report(event);
  return {true, "", true};
}

// More frames after a bump make the new place better, as many as the first one was found by.
void RigWatch::Improve(const Tags& fiducials) {
  improving_->Add(fiducials);
  const vision::RigPose pose = improving_->Solve();
  if (pose.ok()) standing_ = {pose.T_rig_robot, pose.covariance, pose, improving_->Means()};
  if (++improved_by_ >= frames_) improving_.reset();
}

void RigWatch::LookAtMarkers(const BlindWatch::Estimated& estimated) {
  if (saw_fiducials_) return blind_.Forget();
  const auto found = blind_.Look(estimated);
  if (!found) return;
  RigEvent event;
  event.frame = found->frame;
  event.told = estimated.frame;
  if (found->kind == BlindWatch::Finding::Kind::kBack) {
    event.kind = RigEvent::Kind::kBack;
    event.text =
        fmt::format("frame {}: the markers are where they can be again; forces go on", event.frame);
  } else {
    event.kind = RigEvent::Kind::kPerhapsBumped;
    event.text = fmt::format(
        "frame {}: the rig may have been bumped: since then all markers are off alike, by {:.2f} "
        "mm and {:.2f} degrees against the model, and no fiducials are in view. {}, and register "
        "the rig anew",
        event.frame, 1e3 * found->moved, found->turned * 180 / M_PI,
        estimated.usable ? "Check the forces" : "No forces explain it: put it back, or stop here");
  }
  Report(event);
}

}  // namespace softforce::pipeline
