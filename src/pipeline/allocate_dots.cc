// Which dot in which picture is which marker.
#include <algorithm>
#include <cmath>

#include "pipeline/camera_view.h"

namespace softforce::pipeline {
namespace {

FeatureSightings NoSightings(size_t features) {
  FeatureSightings sightings;
  sightings.pixels.resize(features);
  sightings.dots.resize(features);
  return sightings;
}

DotLook LookIn(const std::vector<DotLook>& looks, int camera) {
  return looks.empty() ? DotLook() : looks[camera];
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
                const ObserveOptions& observe, const std::vector<DotLook>& looks);
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
                             double threshold_displacement, const ObserveOptions& observe,
                             const std::vector<DotLook>& looks)
    : num_features(predicted.size()) {
  std::vector<PredictedFeature> features;
  features.reserve(predicted.size());
  for (const MovingFeature& feature : predicted) features.push_back(feature.at);
  options.allocation = observe.allocation;
  options.detection_probability = observe.detection_probability;
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    views.push_back(
        ViewOf(c, rig.cameras[c], T_rig_robot, features, cameras[c], observe, LookIn(looks, c)));
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
                              double threshold_displacement, const ObserveOptions& options,
                              const std::vector<DotLook>& looks) {
  FeatureSightings sightings = NoSightings(predicted.size());
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    const CameraView view =
        ViewOf(c, rig.cameras[c], T_rig_robot, predicted, cameras[c], options, LookIn(looks, c));
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
                                   const std::vector<DotLook>& looks,
                                   const allocation::Belief* near) {
  const JointQuestion question(rig, T_rig_robot, predicted, cameras, threshold_displacement,
                               options, looks);
  return question.Answer(allocation::AllocateJointly(question.predictions, prior,
                                                     question.detections, question.options, near));
}

std::vector<JointSightings> ProposeDots(const camera::Rig& rig,
                                        const Eigen::Isometry3d& T_rig_robot,
                                        const std::vector<MovingFeature>& predicted,
                                        const allocation::Belief& prior,
                                        const std::vector<CameraDetections>& cameras,
                                        int hypotheses, const ObserveOptions& options,
                                        const std::vector<DotLook>& looks) {
  JointQuestion question(rig, T_rig_robot, predicted, cameras, 0, options, looks);
  question.options.max_hypotheses = hypotheses;
  question.options.allocation.threshold_displacement_px = 0;
  std::vector<JointSightings> proposals;
  for (const allocation::JointAllocation& found : allocation::ProposeJointly(
           question.predictions, prior, question.detections, question.options)) {
    proposals.push_back(question.Answer(found));
  }
  return proposals;
}

std::vector<DotLook> LooksOf(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                             const std::vector<PredictedFeature>& features,
                             const std::vector<CameraDetections>& cameras,
                             const FeatureSightings& sightings, const ObserveOptions& options) {
  constexpr size_t kMinDots = 5;
  constexpr double kSpreads = 4;  // standard deviations between markers printed alike
  std::vector<DotLook> looks(rig.cameras.size());
  for (int c = 0; c < static_cast<int>(looks.size()); ++c) {
    const camera::Camera& camera = rig.cameras[c];
    std::vector<double> sizes;  // logarithms of seen over expected
    size_t bright = 0;
    for (size_t f = 0; f < features.size(); ++f) {
      const double depth = (camera.T_camera_rig * T_rig_robot * features[f].position).z();
      for (size_t i = 0; i < sightings.dots[f].size(); ++i) {
        if (sightings.pixels[f][i].camera != c) continue;
        const vision::Dot& dot = cameras[c].dots[sightings.dots[f][i]];
        const double expected = features[f].diameter * camera.lens.fx / depth;
        if (!(dot.long_axis > 0) || !(expected > 0)) continue;
        sizes.push_back(std::log(dot.long_axis / expected));
        bright += dot.contrast > 0;
      }
    }
    if (sizes.size() < kMinDots) continue;
    const double middle = Median(sizes);
    for (double& size : sizes) size = std::abs(size - middle);
    looks[c].scale = std::exp(middle);
    looks[c].tolerance = std::max(options.size_spread, std::exp(kSpreads * 1.48 * Median(sizes)));
    looks[c].bright = 2 * bright > sizes.size();
  }
  return looks;
}

}  // namespace softforce::pipeline
