#include "softforce/pipeline/tracker.h"

#include <algorithm>
#include <cmath>

#include "pipeline/actuators.h"
#include "softforce/base/input_error.h"
#include "softforce/pipeline/observe_points.h"

namespace softforce::pipeline {

void TrackerOptions::Check() const {
  estimator.Check();
  observe.Check();
  if (!(motion_share > 0)) {
    throw base::InputError("tracker: motion_share", "must be greater than 0");
  }
  if (max_markers < 0) throw base::InputError("--max-markers", "must be 0 or more");
  if (!(prediction_floor > 0)) {
    throw base::InputError("tracker: prediction_floor", "must be greater than 0 m");
  }
  if (!(threshold_displacement > 0)) {
    throw base::InputError("tracker: threshold_displacement", "must be greater than 0");
  }
}

geometry::Matrix6d InRobotFrame(const geometry::Matrix6d& rig_covariance,
                                const Eigen::Isometry3d& T_rig_robot) {
  // From a twist on the rig's side of T_rig_robot to one on the robot's side: the adjoint of its
  // inverse.
  const Eigen::Matrix3d R = T_rig_robot.linear().transpose();
  const Eigen::Vector3d t = -(R * T_rig_robot.translation());
  geometry::Matrix6d to_robot = geometry::Matrix6d::Zero();
  to_robot.topLeftCorner<3, 3>() = to_robot.bottomRightCorner<3, 3>() = R;
  to_robot.topRightCorner<3, 3>() = geometry::Skew(t) * R;
  return to_robot * rig_covariance * to_robot.transpose();
}

Tracker::Tracker(const scene::Scene& scene, const World& world, const camera::Rig& rig,
                 const Eigen::Isometry3d& T_rig_robot, const geometry::Matrix6d& rig_covariance,
                 const TrackerOptions& options)
    : scene_(scene),
      world_(world),
      rig_(rig),
      T_rig_robot_(T_rig_robot),
      options_(options),
      features_(scene, world),
      estimator_(world.solver.get(), world.sites, options.estimator, Uncertainties(scene)),
      intensity_covariance_(
          Eigen::MatrixXd::Zero(estimator_.num_components(), estimator_.num_components())) {
  options_.Check();
  registration_covariance_ = InRobotFrame(rig_covariance, T_rig_robot_);
  estimator_.SetRegistrationCovariance(registration_covariance_);
}

std::vector<PredictedFeature> Tracker::Predict() {
  const Eigen::Matrix3Xd& X = world_.mesh().nodes;
  const Eigen::Matrix3Xd x = X + estimator_.state().u;
  std::vector<PredictedFeature> predicted;
  std::vector<Eigen::Matrix3Xd> compliance;
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(estimator_.num_components());  // m/N
  for (const Feature& feature : features_.features()) {
    predicted.push_back({feature.point.weights.Apply(x) + feature.point.offset,
                         {},
                         mesh::Normal(world_.surface, x, feature.point.at),
                         feature.diameter});
    compliance.push_back(estimator_.Compliance(feature.point.weights));
    largest = largest.cwiseMax(compliance.back().colwise().norm().transpose());
  }
  const double motion = options_.motion_share * world_.marker_spacing;
  const double softest = largest.size() > 0 ? largest.maxCoeff() : 0;
  // A component that moves no marker must not be given an endless walk.
  const Eigen::VectorXd walk = motion / largest.array().max(1e-3 * softest);  // N per frame
  if (softest > 0) intensity_covariance_.diagonal() += walk.cwiseAbs2();
  const double floor2 = options_.prediction_floor * options_.prediction_floor;
  for (size_t f = 0; f < predicted.size(); ++f) {
    predicted[f].covariance = compliance[f] * intensity_covariance_ * compliance[f].transpose() +
                              floor2 * Eigen::Matrix3d::Identity();
  }
  return predicted;
}

FrameResult Tracker::Process(int frame, double time_s,
                             const std::vector<CameraDetections>& detections) {
  FrameResult result;
  result.frame = frame;
  result.time_s = time_s;
  const fem::Actuation actuation = ActuationAt(scene_, time_s);
  const fem::SolveSummary advanced = estimator_.Advance(actuation);

  // Over frames without forces the body may have gone further.
  const double threshold =
      options_.threshold_displacement * world_.marker_spacing * (1 + frames_without_forces_);
  features_.PlaceTags(rig_, T_rig_robot_, detections, estimator_.state().u, threshold,
                      options_.observe);
  const std::vector<PredictedFeature> predicted = Predict();
  const std::vector<FeatureObservation> located = Observe(predicted, detections, threshold);

  const std::vector<char> chosen = Choose(located);
  std::vector<estimation::Observation> observations;
  std::vector<size_t> feature_of;
  observations_.clear();
  for (size_t f = 0; f < located.size(); ++f) {
    if (!chosen[f]) continue;
    const BodyPoint& point = features_.features()[f].point;
    observations.push_back({point.weights, point.offset, located[f].position, located[f].whitening,
                            features_.features()[f].marker});
    feature_of.push_back(f);
    observations_.push_back({static_cast<int>(f), observations.back()});
  }
  const estimation::ForceEstimate estimate = estimator_.Estimate(observations, actuation);

  std::vector<char> rejected(located.size(), 0);
  for (size_t i = 0; i < feature_of.size(); ++i) rejected[feature_of[i]] = estimate.rejected[i];
  result.status = estimate.status;
  result.reason =
      advanced.ok() || estimate.status == estimation::ForceEstimate::Status::kInvalidInput
          ? estimate.reason
          : advanced.BriefReport() + ". " + advanced.Advice();
  result.chi2 = estimate.chi2;
  result.degrees_of_freedom = estimate.degrees_of_freedom;
  frames_without_forces_ = estimate.ok() ? 0 : frames_without_forces_ + 1;
  if (estimate.ok()) {
    intensity_covariance_ = estimate.covariance;
    result.forces = ForceResults(estimate);
  }
  result.markers = MarkerResults(located, rejected);
  TellWhatWasUsed(chosen, rejected, &result.markers);
  AddActuators(actuation, &result);
  return result;
}

std::vector<FeatureObservation> Tracker::Observe(const std::vector<PredictedFeature>& predicted,
                                                 const std::vector<CameraDetections>& detections,
                                                 double threshold) const {
  if (scene_.measured) {
    std::vector<int> markers;
    for (const Feature& feature : features_.features()) markers.push_back(feature.marker);
    return ObservePoints(T_rig_robot_, predicted, markers, detections.front().points, threshold,
                         options_.observe.allocation);
  }
  const FeatureSightings sightings =
      scene_.markers.type == scene::MarkerType::kDot
          ? AllocateDots(rig_, T_rig_robot_, predicted, detections, threshold, options_.observe)
          : AllocateTagCorners(scene_.markers, rig_, T_rig_robot_, features_.features(), predicted,
                               detections, threshold, options_.observe);
  return Locate(rig_, T_rig_robot_, predicted, sightings, options_.observe);
}

void Tracker::AddActuators(const fem::Actuation& actuation, FrameResult* result) const {
  for (size_t c = 0; c < world_.solver->body().cables.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    result->cables.push_back({world_.solver->body().cables[c].name, estimator_.state().tension(i),
                              estimator_.state().shortening(i)});
  }
  for (size_t k = 0; k < actuation.pressures.size(); ++k) {
    result->chambers.push_back(
        {world_.solver->body().chambers[k].name, estimator_.state().load.actuation.pressures[k]});
  }
}

FrameResult Tracker::Skip(int frame, double time_s, const std::string& reason) {
  FrameResult result;
  result.frame = frame;
  result.time_s = time_s;
  result.status = estimation::ForceEstimate::Status::kInconsistent;
  result.reason = reason;
  const fem::Actuation actuation = ActuationAt(scene_, time_s);
  estimator_.Advance(actuation);
  ++frames_without_forces_;
  observations_.clear();
  const size_t features = features_.features().size();
  result.markers =
      MarkerResults(std::vector<FeatureObservation>(features), std::vector<char>(features, 0));
  AddActuators(actuation, &result);
  return result;
}

void Tracker::PlaceRig(const Eigen::Isometry3d& T_rig_robot,
                       const geometry::Matrix6d& rig_covariance) {
  T_rig_robot_ = T_rig_robot;
  registration_covariance_ = InRobotFrame(rig_covariance, T_rig_robot);
  estimator_.SetRegistrationCovariance(registration_covariance_);
}

std::vector<ForceResult> Tracker::ForceResults(const estimation::ForceEstimate& estimate) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  std::vector<ForceResult> forces;
  forces.reserve(world_.sites.size());
  for (int s = 0; s < static_cast<int>(world_.sites.size()); ++s) {
    forces.push_back({scene_.forces.candidates[s].id, world_.sites[s].at.Apply(x),
                      world_.sites[s].at.Apply(world_.mesh().nodes),
                      estimator_.Force(estimate.intensity, s),
                      estimator_.ForceCovariance(estimate.covariance, s)});
  }
  return forces;
}

// A dot is its only feature. A tag is measured by its corners: its centre is where the model has
// it, moved by the mean misfit of the corners, since the surface between them is curved.
std::vector<MarkerResult> Tracker::MarkerResults(
    const std::vector<FeatureObservation>& observations, const std::vector<char>& rejected) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  std::vector<MarkerResult> markers;
  for (size_t m = 0; m < world_.markers.size(); ++m) {
    MarkerResult marker;
    marker.id = scene_.markers.points[m].id;
    marker.model = world_.markers[m].weights.Apply(x) + world_.markers[m].offset;
    Eigen::Vector3d misfit = Eigen::Vector3d::Zero();
    double variance = 0;
    int seen = 0;
    for (size_t f = 0; f < observations.size(); ++f) {
      const Feature& feature = features_.features()[f];
      const FeatureObservation& observation = observations[f];
      if (feature.marker != static_cast<int>(m)) continue;
      if (observation.status == FeatureObservation::Status::kInconsistent || rejected[f]) {
        if (seen == 0) marker.status = MarkerStatus::kRejected;
        continue;
      }
      if (!observation.position.allFinite()) continue;
      misfit += observation.position - (feature.point.weights.Apply(x) + feature.point.offset);
      variance += observation.covariance.trace() / 3;
      const bool one_camera = observation.status == FeatureObservation::Status::kOneCamera;
      if (one_camera || seen == 0) {
        marker.status = one_camera ? MarkerStatus::kOneCamera : MarkerStatus::kSeen;
      }
      ++seen;
    }
    if (seen > 0) {
      marker.measured = marker.model + misfit / seen;
      marker.sd = std::sqrt(variance) / seen;
    }
    markers.push_back(marker);
  }
  return markers;
}

}  // namespace softforce::pipeline
