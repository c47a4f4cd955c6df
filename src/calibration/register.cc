#include "softforce/calibration/register.h"

#include <algorithm>

namespace softforce::calibration {
namespace {

// What the mean over frames does not take away from a corner: lens model, print, compression. px.
constexpr double kCornerFloor = 0.03;

// Reprojection error from which on something other than noise must be wrong. px.
constexpr double kSuspiciousRms = 3;

// Whether a picture shows a second tag of the same id: a stray print or a mirror image, and nobody
// knows which of the two is the fiducial.
bool SeenTwice(const std::vector<vision::Tag>& tags, const vision::Tag& tag) {
  return std::count_if(tags.begin(), tags.end(), [&](const vision::Tag& other) {
           return other.family == tag.family && other.id == tag.id;
         }) > 1;
}

}  // namespace

FiducialRegistration::FiducialRegistration(const camera::Rig& rig, std::vector<Fiducial> fiducials)
    : rig_(rig), fiducials_(std::move(fiducials)) {}

std::vector<std::string> FiducialRegistration::Families() const {
  std::vector<std::string> families;
  for (const Fiducial& fiducial : fiducials_) families.push_back(fiducial.family);
  std::sort(families.begin(), families.end());
  families.erase(std::unique(families.begin(), families.end()), families.end());
  return families;
}

void FiducialRegistration::Add(const std::vector<std::vector<vision::Tag>>& tags_of_camera) {
  for (int c = 0; c < static_cast<int>(tags_of_camera.size()); ++c) {
    for (const vision::Tag& tag : tags_of_camera[c]) {
      if (SeenTwice(tags_of_camera[c], tag)) continue;
      for (int f = 0; f < static_cast<int>(fiducials_.size()); ++f) {
        if (fiducials_[f].id != tag.id || fiducials_[f].family != tag.family) continue;
        AddTag(c, f, tag);
      }
    }
  }
}

void FiducialRegistration::AddTag(int camera, int fiducial, const vision::Tag& tag) {
  auto mean = std::find_if(means_.begin(), means_.end(), [&](const CornerMean& m) {
    return m.camera == camera && m.fiducial == fiducial;
  });
  if (mean == means_.end()) {
    CornerMean fresh;
    fresh.camera = camera;
    fresh.fiducial = fiducial;
    fresh.sum.fill(Eigen::Vector2d::Zero());
    fresh.covariance_sum.fill(Eigen::Matrix2d::Zero());
    mean = means_.insert(means_.end(), fresh);
  }
  ++mean->count;
  for (int i = 0; i < 4; ++i) {
    mean->sum[i] += tag.corners[i];
    mean->covariance_sum[i] += tag.corner_covariances[i];
  }
}

int FiducialRegistration::num_sightings() const {
  int count = 0;
  for (const CornerMean& mean : means_) count += mean.count;
  return count;
}

std::vector<MeanTag> FiducialRegistration::Means() const {
  std::vector<MeanTag> tags;
  for (const CornerMean& mean : means_) {
    MeanTag tag{mean.camera, mean.fiducial, mean.count, mean.sum, mean.covariance_sum};
    for (int i = 0; i < 4; ++i) {
      tag.corners[i] /= mean.count;
      tag.covariances[i] /= mean.count;
    }
    tags.push_back(tag);
  }
  return tags;
}

vision::RigPose FiducialRegistration::SolveTurned(int quarter_turns) const {
  std::vector<vision::PointSighting> sightings;
  for (const CornerMean& mean : means_) {
    const double n = mean.count;
    for (int i = 0; i < 4; ++i) {
      sightings.push_back({fiducials_[mean.fiducial].corners[(i + quarter_turns) % 4], mean.camera,
                           mean.sum[i] / n,
                           mean.covariance_sum[i] / (n * n) +
                               kCornerFloor * kCornerFloor * Eigen::Matrix2d::Identity()});
    }
  }
  return vision::EstimateRigPose(rig_, sightings);
}

vision::RigPose FiducialRegistration::Solve() const {
  vision::RigPose upright = SolveTurned(0);
  if (upright.ok() && upright.rms_px < kSuspiciousRms) return upright;
  // Printed from another source, all tags may be turned alike; several tags tell, one cannot.
  const bool several = std::any_of(means_.begin(), means_.end(), [&](const CornerMean& mean) {
    return mean.fiducial != means_.front().fiducial;
  });
  vision::RigPose best = upright;
  for (int turns = 1; several && turns < 4; ++turns) {
    const vision::RigPose turned = SolveTurned(turns);
    if (turned.ok() && turned.rms_px < kSuspiciousRms) best = turned;
  }
  return best;
}

}  // namespace softforce::calibration
