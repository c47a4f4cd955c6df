#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "softforce/allocation/allocate.h"
#include "softforce/allocation/allocate_jointly.h"
#include "softforce/camera/rig.h"
#include "softforce/camera/triangulate.h"
#include "softforce/scene/measured.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/tags.h"

namespace softforce::pipeline {

// A point of a marker that is measured by itself: the centre of a dot, or a corner of a tag.
struct PredictedFeature {
  Eigen::Vector3d position;    // m, robot frame
  Eigen::Matrix3d covariance;  // m², of the prediction
  Eigen::Vector3d normal;      // of the surface there, outward
  double diameter = 0;         // m, of the dot; 0 for a corner
  // Per camera of the rig: whether the body itself stands in the way. Empty: in none.
  std::vector<char> covered = {};
};

// The same as a function of what all features share, the body's forces and the rig's place: a
// feature is at position + jacobian · delta, give or take an error of its own.
struct MovingFeature {
  PredictedFeature at;        // the covariance is that of its own error
  Eigen::Matrix3Xd jacobian;  // m per unit of delta
};

// What one camera saw of feature points. For dots the detections are anonymous; for tags they come
// with ids. Motion capture stands for one camera: it sees points in space, with labels or without.
struct CameraDetections {
  std::vector<vision::Dot> dots;
  std::vector<vision::Tag> tags;
  std::vector<scene::MeasuredPoint> points = {};
};

// Where a feature point was measured.
struct FeatureObservation {
  enum class Status { kHidden, kSeen, kOneCamera, kInconsistent };

  Status status = Status::kHidden;
  Eigen::Vector3d position = Eigen::Vector3d::Constant(NAN);    // m, robot frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(NAN);  // m²; kSeen only
  // k×3, k = 3 if kSeen, 2 if kOneCamera: see estimation::Observation.
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> whitening;
  int cameras = 0;  // that saw it
};

// How the dots on the body look in one camera, told by those that were allocated in the last frame:
// a decoy seldom looks the same.
struct DotLook {
  double scale = 1;      // of their long axes, over what the scene's size and the place say
  double tolerance = 0;  // a dot may be this much larger or smaller; 0: nothing is known yet
  bool bright = true;    // brighter than what is around them
};

struct ObserveOptions {
  allocation::AllocationOptions allocation;
  double detection_probability = 0.7;  // of a marker that should be seen
  camera::TriangulationOptions triangulation;
  // What a dot's or corner's covariance from the picture leaves out: lens model, compression,
  // print. px.
  double pixel_floor = 0.03;
  double min_facing = 0.1;      // cosine between a marker's normal and the way to the camera
  double size_tolerance = 1.7;  // a dot's picture may be this much larger or smaller than expected
  double size_spread = 1.25;  // the same, once the others on the body have shown how large they are

  void Check() const;  // throws InputError naming the option
};

// Which detection in which camera belongs to which feature, by prediction, gate and global
// assignment. `pixels[feature]` are the sightings; for dots, corrected from the centroid of the
// disc's picture to the projection of its centre.
struct FeatureSightings {
  std::vector<std::vector<camera::PixelObservation>> pixels;
  std::vector<std::vector<int>> dots;  // for dots: their numbers among the camera's detections
};

// `threshold_displacement`: the paper's threshold, m; a detection further from its prediction is
// not it. `looks`: per camera, or empty if nothing is known yet.
FeatureSightings AllocateDots(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                              const std::vector<PredictedFeature>& predicted,
                              const std::vector<CameraDetections>& cameras,
                              double threshold_displacement, const ObserveOptions& options,
                              const std::vector<DotLook>& looks = {});

// How the dots look that were sighted, per camera; nothing is known where they are too few to tell.
std::vector<DotLook> LooksOf(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                             const std::vector<PredictedFeature>& features,
                             const std::vector<CameraDetections>& cameras,
                             const FeatureSightings& sightings, const ObserveOptions& options);

struct JointSightings {
  FeatureSightings sightings;
  allocation::Belief delta;  // given these
};

// The same in all cameras at once, see allocation::AllocateJointly.
JointSightings AllocateDotsJointly(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                                   const std::vector<MovingFeature>& predicted,
                                   const allocation::Belief& prior,
                                   const std::vector<CameraDetections>& cameras,
                                   double threshold_displacement, const ObserveOptions& options,
                                   const std::vector<DotLook>& looks = {},
                                   const allocation::Belief* near = nullptr);

// What may have been seen, for a caller who finds out which of these is true: see
// allocation::ProposeJointly. Follows up to `hypotheses` of them, and has no threshold.
std::vector<JointSightings> ProposeDots(const camera::Rig& rig,
                                        const Eigen::Isometry3d& T_rig_robot,
                                        const std::vector<MovingFeature>& predicted,
                                        const allocation::Belief& prior,
                                        const std::vector<CameraDetections>& cameras,
                                        int hypotheses, const ObserveOptions& options,
                                        const std::vector<DotLook>& looks = {});

// From sightings to measured places: two cameras or more triangulate, one gives two equations.
std::vector<FeatureObservation> Locate(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                                       const std::vector<PredictedFeature>& predicted,
                                       const FeatureSightings& sightings,
                                       const ObserveOptions& options);

}  // namespace softforce::pipeline
