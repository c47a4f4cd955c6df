#include "softforce/pipeline/features.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <map>

#include "softforce/geometry/chi_square.h"

namespace softforce::pipeline {
namespace {

// The tag of an id; nothing if a second one like it is in the picture, since one of the two is a
// decoy.
const vision::Tag* FindTag(const CameraDetections& camera, const scene::Markers& markers, int id) {
  const vision::Tag* found = nullptr;
  for (const vision::Tag& tag : camera.tags) {
    if (tag.id != id || tag.family != markers.family) continue;
    if (found != nullptr) return nullptr;
    found = &tag;
  }
  return found;
}

// A mean of places on the body under construction.
struct PlaceMean {
  std::map<int, double> weights;  // per node
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  void Add(const World& world, const Eigen::Vector3d& place, double share) {
    const mesh::SurfaceProjection on =
        mesh::ClosestSurfacePoint(world.surface, world.mesh().nodes, place);
    const mesh::NodalWeights shape = mesh::ShapeFunctions(world.surface, on.at);
    for (size_t n = 0; n < shape.nodes.size(); ++n) {
      weights[shape.nodes[n]] += share * shape.weights[n];
    }
    offset += share * (place - on.position);
  }
};

// Where corner i of a tag is seen. A detected corner is where straight lines through the tag's
// sides cross; on a body that bends the sides are curved, and the lines' ends miss the material
// corner (by 0.05 mm for 14 mm on a radius of 0.45 m). So the end of each side's line is taken,
// as a mean of places along it, and of both ends the middle.
BodyPoint SeenCorner(const World& world, const std::array<Eigen::Vector3d, 4>& corners, int i) {
  constexpr int kSamples = 9;
  constexpr double kMargin = 0.1;  // of a side, at either end, that the lines leave out
  PlaceMean mean;
  for (const int other : {(i + 1) % 4, (i + 3) % 4}) {
    double spread = 0;
    std::array<double, kSamples> along;  // from this corner (0) to the other (1), less 1/2
    for (int k = 0; k < kSamples; ++k) {
      along[k] = (1 - 2 * kMargin) * (static_cast<double>(k) / (kSamples - 1) - 0.5);
      spread += along[k] * along[k];
    }
    for (int k = 0; k < kSamples; ++k) {
      const double share = 1.0 / kSamples - 0.5 * along[k] / spread;  // of the line's value at 0
      const double s = along[k] + 0.5;
      mean.Add(world, (1 - s) * corners[i] + s * corners[other], 0.5 * share);
    }
  }
  BodyPoint point;
  point.at = mesh::ClosestSurfacePoint(world.surface, world.mesh().nodes, corners[i]).at;
  for (const auto& [node, weight] : mean.weights) {
    point.weights.nodes.push_back(node);
    point.weights.weights.push_back(weight);
  }
  point.offset = mean.offset;
  return point;
}

}  // namespace

MarkerFeatures::MarkerFeatures(const scene::Scene& scene, const World& world)
    : scene_(scene), world_(world), placed_(scene.markers.points.size(), 0) {
  if (scene.markers.type != scene::MarkerType::kDot) return;
  for (int m = 0; m < static_cast<int>(world.markers.size()); ++m) {
    features_.push_back({m, -1, world.markers[m], scene.markers.size});
    placed_[m] = 1;
  }
}

void MarkerFeatures::PlaceTags(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                               const std::vector<CameraDetections>& cameras,
                               const Eigen::Matrix3Xd& u, double threshold,
                               const ObserveOptions& options) {
  const Eigen::Matrix2d floor =
      options.pixel_floor * options.pixel_floor * Eigen::Matrix2d::Identity();
  for (int m = 0; m < static_cast<int>(placed_.size()); ++m) {
    if (placed_[m]) continue;
    std::array<std::vector<camera::PixelObservation>, 4> pixels;
    for (int c = 0; c < static_cast<int>(cameras.size()); ++c) {
      const vision::Tag* tag = FindTag(cameras[c], scene_.markers, scene_.markers.points[m].id);
      if (tag == nullptr) continue;
      for (int i = 0; i < 4; ++i) {
        pixels[i].push_back({c, tag->corners[i], tag->corner_covariances[i] + floor});
      }
    }
    std::array<Eigen::Vector3d, 4> corner;
    bool found = true;
    for (int i = 0; i < 4 && found; ++i) {
      const camera::Triangulation at = camera::Triangulate(rig, pixels[i]);
      found = at.ok();
      if (found) corner[i] = T_rig_robot.inverse() * at.p_rig;
    }
    if (!found) continue;
    // A tag of that id somewhere else is not the one on the body.
    const Eigen::Vector3d middle = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
    const BodyPoint& place = world_.markers[m];
    const Eigen::Vector3d expected =
        place.weights.Apply(world_.mesh().nodes) + place.weights.Apply(u) + place.offset;
    if ((middle - expected).norm() > threshold) continue;
    PlaceTag(m, corner[0] + corner[1] - corner[2] - corner[3], u);
  }
}

void MarkerFeatures::PlaceTag(int marker, const Eigen::Vector3d& up_robot,
                              const Eigen::Matrix3Xd& u) {
  const Eigen::Matrix3Xd& X = world_.mesh().nodes;
  const BodyPoint& centre = world_.markers[marker];
  const Eigen::Vector3d normal = mesh::Normal(world_.surface, X, centre.at);
  const Eigen::Vector3d normal_now = mesh::Normal(world_.surface, X + u, centre.at);
  // Back to the body at rest by the smallest rotation that undoes the tilt of the surface.
  const Eigen::Vector3d turned = Eigen::Quaterniond::FromTwoVectors(normal_now, normal) * up_robot;
  const Eigen::Vector3d up = (turned - turned.dot(normal) * normal).normalized();
  const Eigen::Vector3d right = up.cross(normal);
  const double half = scene_.markers.size / 2;
  const std::array<Eigen::Vector2d, 4> square{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
  std::array<Eigen::Vector3d, 4> corners;
  for (int i = 0; i < 4; ++i) {
    corners[i] = scene_.markers.points[marker].position +
                 half * (square[i].x() * right + square[i].y() * up);
  }
  for (int i = 0; i < 4; ++i) {
    features_.push_back({marker, i, SeenCorner(world_, corners, i), 0});
  }
  placed_[marker] = 1;
}

FeatureSightings AllocateTagCorners(const scene::Markers& markers, const camera::Rig& rig,
                                    const Eigen::Isometry3d& T_rig_robot,
                                    const std::vector<Feature>& features,
                                    const std::vector<PredictedFeature>& predicted,
                                    const std::vector<CameraDetections>& cameras,
                                    double threshold_displacement, const ObserveOptions& options) {
  const double gate = geometry::ChiSquareQuantile(options.allocation.gate_probability, 2);
  const double floor2 = options.pixel_floor * options.pixel_floor;
  FeatureSightings sightings;
  sightings.pixels.resize(features.size());
  sightings.dots.resize(features.size());
  for (size_t f = 0; f < features.size(); ++f) {
    for (int c = 0; c < static_cast<int>(cameras.size()); ++c) {
      const vision::Tag* tag = FindTag(cameras[c], markers, markers.points[features[f].marker].id);
      if (tag == nullptr) continue;
      const camera::Camera& camera = rig.cameras[c];
      const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot;
      const camera::Projection at =
          camera::Project(camera.lens, T_camera_robot * predicted[f].position);
      if (!at.visible) continue;
      const int i = features[f].corner;
      const Eigen::Matrix2d noise =
          tag->corner_covariances[i] + floor2 * Eigen::Matrix2d::Identity();
      const Eigen::Matrix<double, 2, 3> J = at.jacobian * T_camera_robot.linear();
      const Eigen::Matrix2d S = J * predicted[f].covariance * J.transpose() + noise;
      const Eigen::Vector2d nu = tag->corners[i] - at.pixel;
      const double depth = (T_camera_robot * predicted[f].position).z();
      if (nu.norm() > threshold_displacement * camera.lens.fx / depth) continue;
      if (!(nu.dot(S.inverse() * nu) <= gate)) continue;
      sightings.pixels[f].push_back({c, tag->corners[i], noise});
    }
  }
  return sightings;
}

}  // namespace softforce::pipeline
