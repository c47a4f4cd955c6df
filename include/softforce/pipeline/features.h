#pragma once

#include <vector>

#include "softforce/pipeline/observe.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// A point of a marker on the body.
struct Feature {
  int marker = -1;  // number in the scene's list
  int corner = -1;  // of a tag: 0 … 3 for TL TR BR BL; −1: the centre of a dot
  BodyPoint point;
  double diameter = 0;  // m, of a dot; 0 for a corner
};

// The feature points of the body's markers. Dots are known from the scene. How a tag is turned on
// the body is not in the scene: it is read off the first frame in which two cameras see it, and its
// corners become features from then on.
class MarkerFeatures {
 public:
  MarkerFeatures(const scene::Scene& scene, const World& world);

  const std::vector<Feature>& features() const { return features_; }

  // Looks for markers that are tags without corners yet, and places their corners. `u`:
  // displacement of the nodes that the model expects in this frame; a tag further than `threshold`
  // (m) from where its marker should be is not it.
  void PlaceTags(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                 const std::vector<CameraDetections>& cameras, const Eigen::Matrix3Xd& u,
                 double threshold, const ObserveOptions& options);

 private:
  void PlaceTag(int marker, const Eigen::Vector3d& up_robot, const Eigen::Matrix3Xd& u);

  const scene::Scene& scene_;
  const World& world_;
  std::vector<Feature> features_;
  std::vector<char> placed_;  // per marker
};

// Tag corners by id and family, gated by prediction and by the paper's threshold displacement (m).
FeatureSightings AllocateTagCorners(const scene::Markers& markers, const camera::Rig& rig,
                                    const Eigen::Isometry3d& T_rig_robot,
                                    const std::vector<Feature>& features,
                                    const std::vector<PredictedFeature>& predicted,
                                    const std::vector<CameraDetections>& cameras,
                                    double threshold_displacement, const ObserveOptions& options);

}  // namespace softforce::pipeline
