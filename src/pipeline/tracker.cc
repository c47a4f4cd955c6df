#include "softforce/pipeline/tracker.h"

#include <algorithm>
#include <cmath>

#include "pipeline/actuators.h"
#include "pipeline/force_locator.h"
#include "pipeline/shape_memory.h"
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
  if (!(nonlinearity > 0)) {
    throw base::InputError("tracker: nonlinearity", "must be greater than 0");
  }
  if (!(prediction_floor > 0)) {
    throw base::InputError("tracker: prediction_floor", "must be greater than 0 m");
  }
  if (!(region_floor > 0)) {
    throw base::InputError("tracker: region_floor", "must be greater than 0 m");
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
      estimator_(world.solver.get(),
                 scene.forces.known_locations ? world.sites : FollowingSites(world),
                 scene.forces.known_locations ? options.estimator
                                              : FollowingOptions(world, options.estimator),
                 Uncertainties(scene)),
      shapes_(std::make_unique<ShapeMemory>(world.marker_spacing)),
      intensity_covariance_(
          Eigen::MatrixXd::Zero(estimator_.num_components(), estimator_.num_components())) {
  options_.Check();
  registration_covariance_ = InRobotFrame(rig_covariance, T_rig_robot_);
  estimator_.SetRegistrationCovariance(registration_covariance_);
  constexpr double kFirstGuess = 0.01e-3;  // m
  own_variance_ = kFirstGuess * kFirstGuess;
  if (scene.forces.known_locations) return;
  if (options.estimator.method != estimation::EstimationMethod::kConverged) {
    throw base::InputError("--method",
                           "is for forces at known places; the scene has 'known: false'");
  }
  estimation::LocationOptions location = options.location;
  location.estimator = options.estimator;
  locator_ = std::make_unique<ForceLocator>(scene, world, location);
  locator_->SetRegistrationCovariance(registration_covariance_);
}

Tracker::~Tracker() = default;

const fem::Equilibrium& Tracker::state() const {
  return locator_ ? locator_->state() : estimator_.state();
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
  Attempt attempt =
      Settle(Allocate(detections, threshold), detections, threshold, actuation, false);
  const bool invalid = attempt.estimate.status == estimation::ForceEstimate::Status::kInvalidInput;
  if (!attempt.estimate.ok() && !invalid && attempt.allocated.joint()) {
    if (auto found = SearchWidely(detections, actuation)) attempt = std::move(*found);
  }
  const estimation::ForceEstimate& estimate = attempt.estimate;
  const std::vector<FeatureObservation>& located = attempt.allocated.located;
  sightings_ = std::move(attempt.allocated.sightings);
  observations_ = std::move(attempt.observations);
  std::vector<char> rejected(located.size(), 0);
  for (size_t i = 0; i < observations_.size(); ++i) {
    rejected[observations_[i].feature] = estimate.rejected[i];
  }
  result.status = estimate.status;
  result.reason = advanced.ok() || invalid ? estimate.reason
                                           : advanced.BriefReport() + ". " + advanced.Advice();
  result.chi2 = estimate.chi2;
  result.degrees_of_freedom = estimate.degrees_of_freedom;
  frames_without_forces_ = estimate.ok() ? 0 : frames_without_forces_ + 1;
  if (estimate.ok()) {
    search_ = {};
    intensity_covariance_ = estimate.covariance;
    if (locator_) {
      LocateForces(actuation, &result, &rejected);
    } else {
      result.forces = ForceResults(estimate);
    }
  }
  if (estimate.ok() && attempt.allocated.joint()) {
    LearnLooks(detections, rejected);
    const std::vector<PredictedFeature> features = PlacedFeatures();
    if (shapes_->IsNew(features)) shapes_->Learn(estimator_.Remember(), features);
  }
  sighted_before_ = estimate.ok() ? std::move(sighted_) : std::vector<std::vector<char>>();
  result.markers = MarkerResults(located, rejected);
  TellWhatIsAbsent(&result.markers);
  TellWhatWasUsed(attempt.chosen, rejected, &result.markers);
  if (estimate.ok()) ExpectMarkers(located, rejected, &result.markers);
  AddActuators(actuation, &result);
  return result;
}

FrameResult Tracker::Skip(int frame, double time_s, const std::string& reason) {
  FrameResult result;
  result.frame = frame;
  result.time_s = time_s;
  result.status = estimation::ForceEstimate::Status::kInconsistent;
  result.reason = reason;
  const fem::Actuation actuation = ActuationAt(scene_, time_s);
  estimator_.Advance(actuation);
  if (locator_) locator_->Advance(actuation);
  ++frames_without_forces_;
  observations_.clear();
  sightings_ = {};
  sighted_before_.clear();
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
  if (locator_) locator_->SetRegistrationCovariance(registration_covariance_);
}

}  // namespace softforce::pipeline
