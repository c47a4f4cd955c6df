#include "pipeline/camera_view.h"

#include <algorithm>

namespace softforce::pipeline {
namespace {

View Expect(int c, const camera::Camera& camera, const Eigen::Isometry3d& T_camera_robot,
            const PredictedFeature& feature, double min_facing) {
  View view;
  if (!feature.covered.empty() && feature.covered[c]) return view;
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

// The dots that look as some expected marker could.
std::vector<int> DotsThatMayBeMarkers(const std::vector<vision::Dot>& dots,
                                      const std::vector<View>& views, double tolerance,
                                      const DotLook& look) {
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
    if (size < smallest / tolerance || size > largest * tolerance) continue;
    if (look.tolerance > 0) {
      const double scaled = size / look.scale;
      if (scaled < smallest / look.tolerance || scaled > largest * look.tolerance) continue;
      if ((dots[d].contrast > 0) != look.bright) continue;
    }
    kept.push_back(d);
  }
  return kept;
}

}  // namespace

CameraView ViewOf(int c, const camera::Camera& camera, const Eigen::Isometry3d& T_rig_robot,
                  const std::vector<PredictedFeature>& predicted, const CameraDetections& seen,
                  const ObserveOptions& options, const DotLook& look) {
  CameraView view;
  const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot;
  for (int f = 0; f < static_cast<int>(predicted.size()); ++f) {
    view.features.push_back(Expect(c, camera, T_camera_robot, predicted[f], options.min_facing));
    if (!view.features[f].expected) continue;
    view.expected.push_back(f);
    view.nearest = std::min(view.nearest, (T_camera_robot * predicted[f].position).z());
  }
  view.kept = DotsThatMayBeMarkers(seen.dots, view.features, options.size_tolerance, look);
  for (const int d : view.kept) {
    view.detections.push_back(
        {seen.dots[d].centroid, WithFloor(seen.dots[d].covariance, options.pixel_floor)});
  }
  return view;
}

bool IsExpected(int c, const camera::Camera& camera, const Eigen::Isometry3d& T_rig_robot,
                const PredictedFeature& feature, const ObserveOptions& options) {
  return Expect(c, camera, camera.T_camera_rig * T_rig_robot, feature, options.min_facing).expected;
}

}  // namespace softforce::pipeline
