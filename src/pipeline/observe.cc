#include "softforce/pipeline/observe.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

// Two equations from one camera: across its ray, at the depth where the model expects the point.
FeatureObservation FromOneCamera(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                                 const Eigen::Vector3d& predicted,
                                 const camera::PixelObservation& seen) {
  FeatureObservation observation;
  const camera::Camera& camera = rig.cameras[seen.camera];
  const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot;
  const auto ray = camera::Unproject(camera.lens, seen.pixel);
  if (!ray) return observation;
  const double depth = (T_camera_robot * predicted).z();
  const Eigen::Vector3d p_camera = depth * ray->homogeneous();
  const camera::Projection at = camera::Project(camera.lens, p_camera);
  if (!at.visible) return observation;
  observation.status = FeatureObservation::Status::kOneCamera;
  observation.position = T_camera_robot.inverse() * p_camera;
  const Eigen::Matrix2d L = seen.covariance.llt().matrixL();
  observation.whitening = L.inverse() * at.jacobian * T_camera_robot.linear();
  observation.cameras = 1;
  return observation;
}

FeatureObservation FromCameras(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                               const Eigen::Vector3d& predicted,
                               const std::vector<camera::PixelObservation>& pixels,
                               const camera::TriangulationOptions& options) {
  FeatureObservation observation;
  const camera::Triangulation found = camera::Triangulate(rig, pixels, options);
  observation.cameras = static_cast<int>(pixels.size());
  if (found.status == camera::Triangulation::Status::kLowParallax) {
    return FromOneCamera(rig, T_rig_robot, predicted, pixels.front());  // they see alike
  }
  if (!found.ok()) {
    observation.status = FeatureObservation::Status::kInconsistent;
    return observation;
  }
  const Eigen::Matrix3d R = T_rig_robot.linear();
  observation.status = FeatureObservation::Status::kSeen;
  observation.position = T_rig_robot.inverse() * found.p_rig;
  observation.covariance = R.transpose() * found.covariance * R;
  const Eigen::Matrix3d L = observation.covariance.llt().matrixL();
  observation.whitening = L.inverse();
  return observation;
}

}  // namespace

void ObserveOptions::Check() const {
  allocation.Check();
  triangulation.Check();
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("observe option ") + option, rule);
  };
  require(detection_probability > 0 && detection_probability < 1, "detection_probability",
          "must lie between 0 and 1");
  require(pixel_floor > 0 && std::isfinite(pixel_floor), "pixel_floor",
          "must be greater than 0 px");
  require(min_facing >= 0 && min_facing < 1, "min_facing", "must be at least 0 and below 1");
  require(size_tolerance > 1, "size_tolerance", "must be greater than 1");
  require(size_spread > 1, "size_spread", "must be greater than 1");
}

std::vector<FeatureObservation> Locate(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                                       const std::vector<PredictedFeature>& predicted,
                                       const FeatureSightings& sightings,
                                       const ObserveOptions& options) {
  std::vector<FeatureObservation> observations;
  for (size_t f = 0; f < predicted.size(); ++f) {
    const std::vector<camera::PixelObservation>& pixels = sightings.pixels[f];
    if (pixels.empty()) {
      observations.emplace_back();
    } else if (pixels.size() == 1) {
      observations.push_back(FromOneCamera(rig, T_rig_robot, predicted[f].position, pixels[0]));
    } else {
      observations.push_back(
          FromCameras(rig, T_rig_robot, predicted[f].position, pixels, options.triangulation));
    }
  }
  return observations;
}

}  // namespace softforce::pipeline
