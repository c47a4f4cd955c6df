// Which dot in which picture is which marker.
#include <algorithm>

#include "pipeline/camera_view.h"

namespace softforce::pipeline {
namespace {

FeatureSightings NoSightings(size_t features) {
  FeatureSightings sightings;
  sightings.pixels.resize(features);
  sightings.dots.resize(features);
  return sightings;
}

void AddSighting(const CameraView& view, int camera, int feature,
                 const allocation::AllocatedPixel& allocated, FeatureSightings* sightings) {
  if (allocated.status != allocation::AllocatedPixel::Status::kSeen) return;
  const allocation::DetectedPixel& seen = view.detections[allocated.detection];
  sightings->pixels[feature].push_back(
      {camera, seen.pixel - view.features[feature].centroid_shift, seen.covariance});
  sightings->dots[feature].push_back(view.kept[allocated.detection]);
}

// What allocation::AllocateJointly is asked.
struct JointQuestion {
  JointQuestion(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                const std::vector<MovingFeature>& predicted,
                const std::vector<CameraDetections>& cameras, double threshold_displacement,
                const ObserveOptions& options);
  JointSightings Answer(const allocation::JointAllocation& found) const;

  size_t num_features;
  std::vector<CameraView> views;
  std::vector<allocation::JointPrediction> predictions;
  std::vector<int> feature_of;  // per prediction
  std::vector<std::vector<allocation::DetectedPixel>> detections;
  allocation::JointOptions options;
};

JointQuestion::JointQuestion(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                             const std::vector<MovingFeature>& predicted,
                             const std::vector<CameraDetections>& cameras,
                             double threshold_displacement, const ObserveOptions& observe)
    : num_features(predicted.size()) {
  std::vector<PredictedFeature> features;
  for (const MovingFeature& feature : predicted) features.push_back(feature.at);
  options.allocation = observe.allocation;
  options.detection_probability = observe.detection_probability;
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    views.push_back(ViewOf(c, rig.cameras[c], T_rig_robot, features, cameras[c], observe));
    for (const int f : views[c].expected) {
      const View& at = views[c].features[f];
      predictions.push_back({c, at.pixel, at.J * predicted[f].jacobian,
                             at.J * predicted[f].at.covariance * at.J.transpose()});
      feature_of.push_back(f);
    }
    detections.push_back(views[c].detections);
    options.allocation.threshold_displacement_px =
        std::max(options.allocation.threshold_displacement_px,
                 threshold_displacement * rig.cameras[c].lens.fx / views[c].nearest);
  }
}

JointSightings JointQuestion::Answer(const allocation::JointAllocation& found) const {
  JointSightings result{NoSightings(num_features), found.belief};
  for (size_t i = 0; i < predictions.size(); ++i) {
    const int c = predictions[i].camera;
    AddSighting(views[c], c, feature_of[i], found.pixels[i], &result.sightings);
  }
  return result;
}

}  // namespace

FeatureSightings AllocateDots(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                              const std::vector<PredictedFeature>& predicted,
                              const std::vector<CameraDetections>& cameras,
                              double threshold_displacement, const ObserveOptions& options) {
  FeatureSightings sightings = NoSightings(predicted.size());
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    const CameraView view = ViewOf(c, rig.cameras[c], T_rig_robot, predicted, cameras[c], options);
    std::vector<allocation::PredictedPixel> predictions;
    for (const int f : view.expected) {
      const View& at = view.features[f];
      predictions.push_back({at.pixel, at.J * predicted[f].covariance * at.J.transpose()});
    }
    allocation::AllocationOptions allocate = options.allocation;
    allocate.threshold_displacement_px =
        threshold_displacement * rig.cameras[c].lens.fx / view.nearest;
    const auto allocated = allocation::Allocate(predictions, view.detections, allocate);
    for (size_t i = 0; i < allocated.size(); ++i) {
      AddSighting(view, c, view.expected[i], allocated[i], &sightings);
    }
  }
  return sightings;
}

JointSightings AllocateDotsJointly(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                                   const std::vector<MovingFeature>& predicted,
                                   const allocation::Belief& prior,
                                   const std::vector<CameraDetections>& cameras,
                                   double threshold_displacement, const ObserveOptions& options,
                                   const allocation::Belief* near) {
  const JointQuestion question(rig, T_rig_robot, predicted, cameras, threshold_displacement,
                               options);
  return question.Answer(allocation::AllocateJointly(question.predictions, prior,
                                                     question.detections, question.options, near));
}

std::vector<JointSightings> ProposeDots(const camera::Rig& rig,
                                        const Eigen::Isometry3d& T_rig_robot,
                                        const std::vector<MovingFeature>& predicted,
                                        const allocation::Belief& prior,
                                        const std::vector<CameraDetections>& cameras,
                                        int hypotheses, const ObserveOptions& options) {
  JointQuestion question(rig, T_rig_robot, predicted, cameras, 0, options);
  question.options.max_hypotheses = hypotheses;
  question.options.allocation.threshold_displacement_px = 0;
  std::vector<JointSightings> proposals;
  for (const allocation::JointAllocation& found : allocation::ProposeJointly(
           question.predictions, prior, question.detections, question.options)) {
    proposals.push_back(question.Answer(found));
  }
  return proposals;
}

}  // namespace softforce::pipeline
