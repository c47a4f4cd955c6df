#include "softforce/pipeline/observe_points.h"

#include <algorithm>

#include "softforce/allocation/allocate_places.h"

namespace softforce::pipeline {
namespace {

// m; no system measures better, and nothing is measured exactly.
constexpr double kSmallestSd = 1e-6;

Eigen::Matrix3d CovarianceOf(const scene::MeasuredPoint& point) {
  const double sd = std::max(point.sd, kSmallestSd);
  return sd * sd * Eigen::Matrix3d::Identity();
}

FeatureObservation Seen(const Eigen::Isometry3d& T_rig_robot, const scene::MeasuredPoint& point) {
  FeatureObservation seen;
  seen.status = FeatureObservation::Status::kSeen;
  seen.position = T_rig_robot.inverse() * point.p_rig;
  seen.covariance = CovarianceOf(point);  // the same in all directions, and so in all frames
  seen.whitening = Eigen::Matrix3d::Identity() / std::max(point.sd, kSmallestSd);
  return seen;
}

}  // namespace

std::vector<FeatureObservation> ObservePoints(const Eigen::Isometry3d& T_rig_robot,
                                              const std::vector<PredictedFeature>& predicted,
                                              const std::vector<int>& markers,
                                              const std::vector<scene::MeasuredPoint>& points,
                                              double threshold_displacement,
                                              const allocation::AllocationOptions& options) {
  std::vector<FeatureObservation> observations(predicted.size());
  std::vector<const scene::MeasuredPoint*> unlabelled;
  for (const scene::MeasuredPoint& point : points) {
    if (point.marker < 0) {
      unlabelled.push_back(&point);
      continue;
    }
    const auto found = std::find(markers.begin(), markers.end(), point.marker);
    if (found != markers.end()) observations[found - markers.begin()] = Seen(T_rig_robot, point);
  }
  std::vector<size_t> left;
  std::vector<allocation::PredictedPlace> predictions;
  for (size_t f = 0; f < predicted.size(); ++f) {
    if (observations[f].status == FeatureObservation::Status::kSeen) continue;
    left.push_back(f);
    predictions.push_back({predicted[f].position, predicted[f].covariance});
  }
  std::vector<allocation::DetectedPlace> detections;
  for (const scene::MeasuredPoint* point : unlabelled) {
    detections.push_back({T_rig_robot.inverse() * point->p_rig, CovarianceOf(*point)});
  }
  const auto allocated =
      allocation::AllocatePlaces(predictions, detections, threshold_displacement, options);
  for (size_t i = 0; i < allocated.size(); ++i) {
    if (allocated[i].status != allocation::AllocatedPixel::Status::kSeen) continue;
    observations[left[i]] = Seen(T_rig_robot, *unlabelled[allocated[i].detection]);
  }
  return observations;
}

}  // namespace softforce::pipeline
