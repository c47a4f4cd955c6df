#include "softforce/pipeline/observe.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

// How one camera should see a feature.
struct View {
  bool expected = false;           // in the picture, and turned towards the camera
  Eigen::Vector2d pixel;           // of the detection: the centroid of a dot's picture
  Eigen::Vector2d centroid_shift;  // px; centroid − projection of the centre
  Eigen::Matrix<double, 2, 3> J;   // d pixel / d p_robot, px/m
  double diameter_px = 0;
};

View Expect(const camera::Camera& camera, const Eigen::Isometry3d& T_camera_robot,
            const PredictedFeature& feature, double min_facing) {
  View view;
  const Eigen::Vector3d p_camera = T_camera_robot * feature.position;
  const Eigen::Vector3d normal_camera = T_camera_robot.linear() * feature.normal;
  if (-normal_camera.dot(p_camera.normalized()) < min_facing) return view;
  const camera::Projection centre = camera::Project(camera.lens, p_camera);
  if (!centre.visible) return view;
  view.pixel = centre.pixel;
  view.centroid_shift.setZero();
  if (feature.diameter > 0) {
    const auto centroid =
        camera::ProjectDiscCentroid(camera.lens, p_camera, normal_camera, feature.diameter);
    if (!centroid) return view;
    view.pixel = *centroid;
    view.centroid_shift = *centroid - centre.pixel;
    view.diameter_px = feature.diameter * camera.lens.fx / p_camera.z();
  }
  view.J = centre.jacobian * T_camera_robot.linear();
  view.expected = (view.pixel.array() >= 0).all() && view.pixel.x() < camera.width &&
                  view.pixel.y() < camera.height;
  return view;
}

Eigen::Matrix2d WithFloor(const Eigen::Matrix2d& covariance, double floor_px) {
  return covariance + floor_px * floor_px * Eigen::Matrix2d::Identity();
}

// The dots of a size that some expected marker could have.
std::vector<int> DotsOfRightSize(const std::vector<vision::Dot>& dots,
                                 const std::vector<View>& views, double tolerance) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (const View& view : views) {
    if (!view.expected) continue;
    smallest = std::min(smallest, view.diameter_px);
    largest = std::max(largest, view.diameter_px);
  }
  std::vector<int> kept;
  for (int d = 0; d < static_cast<int>(dots.size()); ++d) {
    const double size = dots[d].long_axis;
    if (size >= smallest / tolerance && size <= largest * tolerance) kept.push_back(d);
  }
  return kept;
}

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
  require(pixel_floor > 0 && std::isfinite(pixel_floor), "pixel_floor",
          "must be greater than 0 px");
  require(min_facing >= 0 && min_facing < 1, "min_facing", "must be at least 0 and below 1");
  require(size_tolerance > 1, "size_tolerance", "must be greater than 1");
}

FeatureSightings AllocateDots(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                              const std::vector<PredictedFeature>& predicted,
                              const std::vector<CameraDetections>& cameras,
                              double threshold_displacement, const ObserveOptions& options) {
  FeatureSightings sightings;
  sightings.pixels.resize(predicted.size());
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    const camera::Camera& camera = rig.cameras[c];
    const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot;
    std::vector<View> views;
    std::vector<int> expected;  // features this camera should see
    std::vector<allocation::PredictedPixel> predictions;
    double nearest = std::numeric_limits<double>::infinity();
    for (int f = 0; f < static_cast<int>(predicted.size()); ++f) {
      views.push_back(Expect(camera, T_camera_robot, predicted[f], options.min_facing));
      if (!views[f].expected) continue;
      expected.push_back(f);
      predictions.push_back(
          {views[f].pixel, views[f].J * predicted[f].covariance * views[f].J.transpose()});
      nearest = std::min(nearest, (T_camera_robot * predicted[f].position).z());
    }
    const std::vector<vision::Dot>& dots = cameras[c].dots;
    const std::vector<int> kept = DotsOfRightSize(dots, views, options.size_tolerance);
    std::vector<allocation::DetectedPixel> detections;
    detections.reserve(kept.size());
    for (const int d : kept) {
      detections.push_back({dots[d].centroid, WithFloor(dots[d].covariance, options.pixel_floor)});
    }

    allocation::AllocationOptions allocate = options.allocation;
    allocate.threshold_displacement_px = threshold_displacement * camera.lens.fx / nearest;
    const auto allocated = allocation::Allocate(predictions, detections, allocate);
    for (size_t i = 0; i < allocated.size(); ++i) {
      if (allocated[i].status != allocation::AllocatedPixel::Status::kSeen) continue;
      const allocation::DetectedPixel& seen = detections[allocated[i].detection];
      sightings.pixels[expected[i]].push_back(
          {c, seen.pixel - views[expected[i]].centroid_shift, seen.covariance});
    }
  }
  return sightings;
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
