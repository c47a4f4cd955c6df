// The tracker's half that finds out which marker is which.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pipeline/by_twist.h"
#include "pipeline/camera_view.h"
#include "pipeline/self_cover.h"
#include "softforce/pipeline/observe_points.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {
namespace {

constexpr double kGround = 1e-3;  // m, what is nearer to a marker is what it lies on

double LargestDisplacement(const World& world, const Eigen::Matrix3Xd& u) {
  double largest = 0;
  for (const BodyPoint& marker : world.markers) {
    largest = std::max(largest, marker.weights.Apply(u).norm());
  }
  return largest;
}

}  // namespace

std::vector<MovingFeature> Tracker::Linearise() const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  const double own = OwnVariance();
  const SelfCover cover(world_.surface, x);
  std::vector<MovingFeature> features;
  for (const Feature& feature : features_.features()) {
    MovingFeature moving;
    moving.at = {feature.point.weights.Apply(x) + feature.point.offset,
                 own * Eigen::Matrix3d::Identity(),
                 mesh::Normal(world_.surface, x, feature.point.at), feature.diameter};
    for (const camera::Camera& camera : rig_.cameras) {
      const Eigen::Vector3d eye = (camera.T_camera_rig * T_rig_robot_).inverse().translation();
      // Where the body may be a little elsewhere, the dot may come into view.
      const double radius = 0.5 * feature.diameter + std::sqrt(own);
      moving.at.covered.push_back(cover.Covers(eye, moving.at.position, moving.at.normal, radius,
                                               std::max(feature.diameter, kGround)));
    }
    moving.jacobian.resize(3, estimator_.num_components() + 6);
    moving.jacobian << estimator_.Compliance(feature.point.weights), ByTwist(moving.at.position);
    features.push_back(std::move(moving));
  }
  return features;
}

double Tracker::OwnVariance() const {
  const double displacement = LargestDisplacement(world_, estimator_.state().u);
  return std::pow(options_.prediction_floor, 2) +
         std::pow(options_.estimator.local_model_error * displacement, 2);
}

Eigen::VectorXd Tracker::Walk(const std::vector<MovingFeature>& features) const {
  const int n = estimator_.num_components();
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(n);  // m/N
  for (const MovingFeature& feature : features) {
    largest = largest.cwiseMax(feature.jacobian.leftCols(n).colwise().norm().transpose());
  }
  const double motion = options_.motion_share * world_.marker_spacing;
  const double softest = largest.size() > 0 ? largest.maxCoeff() : 0;
  Eigen::VectorXd walk = Eigen::VectorXd::Zero(n);
  if (!(softest > 0)) return walk;
  int first = 0;
  for (const estimation::ForceSite& site : estimator_.sites()) {
    const auto directions = static_cast<int>(site.directions.cols());
    // What acts on a place may act in any direction. A place that hardly moves the markers must not
    // be given an endless walk: a thin body would buckle under it.
    const double reach = std::max(largest.segment(first, directions).maxCoeff(), 0.1 * softest);
    walk.segment(first, directions).setConstant(std::pow(motion / reach, 2));
    first += directions;
  }
  return walk;
}

// Of the forces and the rig's place together. What the model gets wrong in common is a rigid motion
// about the middle of the markers.
Eigen::MatrixXd Tracker::SharedCovariance(const Eigen::MatrixXd& intensities) const {
  const auto n = intensities.rows();
  const double displacement = LargestDisplacement(world_, estimator_.state().u);
  const double common = options_.estimator.common_model_error * displacement;
  const auto markers = static_cast<double>(world_.markers.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const BodyPoint& marker : world_.markers) {
    middle += marker.weights.Apply(world_.mesh().nodes) / markers;
  }
  double spread = 0;  // m², mean square distance from the middle
  for (const BodyPoint& marker : world_.markers) {
    spread += (marker.weights.Apply(world_.mesh().nodes) - middle).squaredNorm() / markers;
  }
  geometry::Matrix6d about_middle = geometry::Matrix6d::Zero();
  about_middle.diagonal().head<3>().setConstant(common * common);
  about_middle.diagonal().tail<3>().setConstant(common * common / std::max(spread, 1e-6));
  geometry::Matrix6d to_origin = geometry::Matrix6d::Identity();
  to_origin.topRightCorner<3, 3>() = geometry::Skew(middle);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n + 6, n + 6);
  covariance.topLeftCorner(n, n) = intensities;
  covariance.bottomRightCorner<6, 6>() =
      registration_covariance_ + to_origin * about_middle * to_origin.transpose();
  return covariance;
}

Tracker::Allocated Tracker::Allocate(const std::vector<CameraDetections>& detections,
                                     double threshold) {
  std::vector<MovingFeature> features = Linearise();
  // Over many lost frames it does not go on for ever: the body is held.
  constexpr double kMostWalks = 36;  // variances
  const Eigen::VectorXd walk = Walk(features);
  for (Eigen::Index i = 0; i < walk.size(); ++i) {
    double& variance = intensity_covariance_(i, i);
    variance = std::max(variance, std::min(variance + walk(i), kMostWalks * walk(i)));
  }
  const Eigen::MatrixXd shared = SharedCovariance(intensity_covariance_);
  std::vector<PredictedFeature> predicted;
  for (MovingFeature& feature : features) {
    const Eigen::Matrix3d spread = feature.jacobian * shared * feature.jacobian.transpose();
    predicted.push_back(feature.at);
    predicted.back().covariance += spread;
    // What moves far does not move linearly.
    feature.at.covariance += options_.nonlinearity * options_.nonlinearity * spread.trace() *
                             Eigen::Matrix3d::Identity();
  }
  Allocated allocated;
  if (scene_.measured) {
    std::vector<int> markers;
    for (const Feature& feature : features_.features()) markers.push_back(feature.marker);
    allocated.located = ObservePoints(T_rig_robot_, predicted, markers, detections.front().points,
                                      threshold, options_.observe.allocation);
    return allocated;
  }
  if (scene_.markers.type != scene::MarkerType::kDot) {
    allocated.sightings =
        AllocateTagCorners(scene_.markers, rig_, T_rig_robot_, features_.features(), predicted,
                           detections, threshold, options_.observe);
  } else if (options_.observe.allocation.rule == allocation::Rule::kNearest) {
    allocated.sightings = AllocateDots(rig_, T_rig_robot_, predicted, detections, threshold,
                                       options_.observe, looks_);
  } else {
    allocated.prior = {Eigen::VectorXd::Zero(shared.rows()), shared};
    allocated.intensity = estimator_.intensity();
    JointSightings found = AllocateDotsJointly(rig_, T_rig_robot_, features, allocated.prior,
                                               detections, threshold, options_.observe, looks_);
    LeaveOutUnconfirmed(features, &found.sightings);
    allocated.sightings = std::move(found.sightings);
    allocated.delta = std::move(found.delta);
  }
  allocated.located = Locate(rig_, T_rig_robot_, predicted, allocated.sightings, options_.observe);
  return allocated;
}

// A body that moves by much does not answer linearly. Where the first allocation has brought it,
// the gates need not allow for that any more.
bool Tracker::AllocateAgain(const std::vector<CameraDetections>& detections, double threshold,
                            const Eigen::MatrixXd& covariance, Allocated* allocated) {
  constexpr double kWiden = 4;  // of variances: the first allocation may have been wrong in parts
  const int n = estimator_.num_components();
  const std::vector<MovingFeature> features = Linearise();
  allocation::Belief prior = allocated->prior;
  prior.mean.head(n) = allocated->intensity - estimator_.intensity();
  allocation::Belief near{allocated->delta.mean, kWiden * SharedCovariance(covariance)};
  near.mean.head(n).setZero();
  JointSightings found = AllocateDotsJointly(rig_, T_rig_robot_, features, prior, detections,
                                             2 * threshold, options_.observe, looks_, &near);
  LeaveOutUnconfirmed(features, &found.sightings);
  const bool changed = found.sightings.dots != allocated->sightings.dots;
  std::vector<PredictedFeature> predicted;
  predicted.reserve(features.size());
  for (const MovingFeature& feature : features) predicted.push_back(feature.at);
  allocated->sightings = std::move(found.sightings);
  allocated->delta = std::move(found.delta);
  if (changed) {
    allocated->located =
        Locate(rig_, T_rig_robot_, predicted, allocated->sightings, options_.observe);
  }
  return changed;
}

void Tracker::LeaveOutUnconfirmed(const std::vector<MovingFeature>& features,
                                  FeatureSightings* sightings) {
  const auto cameras = static_cast<int>(rig_.cameras.size());
  sighted_.assign(features.size(), std::vector<char>(cameras, 0));
  for (size_t f = 0; f < features.size(); ++f) {
    std::vector<camera::PixelObservation>& pixels = sightings->pixels[f];
    for (const camera::PixelObservation& pixel : pixels) sighted_[f][pixel.camera] = 1;
    if (pixels.size() != 1 || sighted_before_.empty()) continue;
    const int alone = pixels.front().camera;
    if (sighted_before_[f][alone]) continue;
    bool others = false;
    for (int c = 0; c < cameras; ++c) {
      others = others || (c != alone && IsExpected(c, rig_.cameras[c], T_rig_robot_, features[f].at,
                                                   options_.observe));
    }
    if (!others) continue;
    pixels.clear();
    sightings->dots[f].clear();
  }
}

std::vector<MarkerObservation> Tracker::ObservationsOf(const Allocated& allocated,
                                                       const std::vector<char>& chosen) const {
  std::vector<MarkerObservation> observations;
  for (size_t f = 0; f < allocated.located.size(); ++f) {
    const FeatureObservation& located = allocated.located[f];
    if (!chosen[f]) continue;
    const Feature& feature = features_.features()[f];
    observations.push_back({static_cast<int>(f),
                            {feature.point.weights, feature.point.offset, located.position,
                             located.whitening, feature.marker}});
  }
  return observations;
}

Tracker::Attempt Tracker::Settle(Allocated allocated,
                                 const std::vector<CameraDetections>& detections, double threshold,
                                 const fem::Actuation& actuation, bool again) {
  constexpr int kMaxRounds = 4;
  Attempt attempt;
  attempt.allocated = std::move(allocated);
  for (int round = 0; round < kMaxRounds; ++round) {
    attempt.chosen = Choose(attempt.allocated.located);
    attempt.observations = ObservationsOf(attempt.allocated, attempt.chosen);
    std::vector<estimation::Observation> observations;
    for (const MarkerObservation& seen : attempt.observations) observations.push_back(seen.seen);
    attempt.estimate = again || round > 0 ? estimator_.EstimateAgain(observations, actuation)
                                          : estimator_.Estimate(observations, actuation);
    if (!attempt.estimate.ok() || !attempt.allocated.joint() || round == kMaxRounds - 1) break;
    if (!AllocateAgain(detections, threshold, attempt.estimate.covariance, &attempt.allocated)) {
      break;
    }
  }
  return attempt;
}

std::vector<PredictedFeature> Tracker::PlacedFeatures() const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  std::vector<PredictedFeature> features;
  for (const Feature& feature : features_.features()) {
    PredictedFeature placed;
    placed.position = feature.point.weights.Apply(x) + feature.point.offset;
    placed.normal = mesh::Normal(world_.surface, x, feature.point.at);
    placed.diameter = feature.diameter;
    features.push_back(std::move(placed));
  }
  return features;
}

void Tracker::LearnLooks(const std::vector<CameraDetections>& detections,
                         const std::vector<char>& rejected) {
  const std::vector<PredictedFeature> features = PlacedFeatures();
  FeatureSightings sightings = sightings_;
  for (size_t f = 0; f < features.size(); ++f) {
    if (rejected[f]) sightings.dots[f].clear();
  }
  const std::vector<DotLook> seen =
      LooksOf(rig_, T_rig_robot_, features, detections, sightings, options_.observe);
  looks_.resize(seen.size());
  for (size_t c = 0; c < seen.size(); ++c) {
    if (seen[c].tolerance > 0) looks_[c] = seen[c];
  }
}

}  // namespace softforce::pipeline
