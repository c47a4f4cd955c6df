// The tracker's way back after frames that it could not understand.
#include <algorithm>
#include <limits>

#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {

int Tracker::Attempt::rejected() const {
  return static_cast<int>(std::count(estimate.rejected.begin(), estimate.rejected.end(), 1));
}

int Tracker::Attempt::used() const { return static_cast<int>(observations.size()) - rejected(); }

std::vector<Tracker::Allocated> Tracker::Propose(const std::vector<CameraDetections>& detections,
                                                 const Eigen::MatrixXd& intensities) const {
  constexpr int kHypotheses = 150;
  std::vector<MovingFeature> features = Linearise();
  const Eigen::MatrixXd shared = SharedCovariance(intensities);
  std::vector<PredictedFeature> predicted;
  for (MovingFeature& feature : features) {
    const Eigen::Matrix3d spread = feature.jacobian * shared * feature.jacobian.transpose();
    feature.at.covariance += options_.nonlinearity * options_.nonlinearity * spread.trace() *
                             Eigen::Matrix3d::Identity();
    predicted.push_back(feature.at);
  }
  const allocation::Belief prior{Eigen::VectorXd::Zero(shared.rows()), shared};
  std::vector<Allocated> proposals;
  for (JointSightings& found : ProposeDots(rig_, T_rig_robot_, features, prior, detections,
                                           kHypotheses, options_.observe, looks_)) {
    Allocated allocated;
    allocated.sightings = std::move(found.sightings);
    allocated.delta = std::move(found.delta);
    allocated.prior = prior;
    allocated.located =
        Locate(rig_, T_rig_robot_, predicted, allocated.sightings, options_.observe);
    proposals.push_back(std::move(allocated));
  }
  return proposals;
}

// Looks further about where the body was last, and about where it is without forces. What is
// proposed there is only believed if the forces explain it nearly without rejections, and if
// nothing that differs explains nearly as much: a frame left out is better than markers mixed up.
std::optional<Tracker::Attempt> Tracker::SearchWidely(
    const std::vector<CameraDetections>& detections, const fem::Actuation& actuation) {
  constexpr double kWiden = 4;          // of variances, about the last state
  constexpr double kUnloaded = 36;      // walks' variances, about the unloaded body
  constexpr double kMaxRejected = 0.2;  // of the observations
  constexpr double kLead = 0.8;         // a rival has less than this share of the observations
  constexpr double kAlike = 0.25;       // spacings, between the markers of two answers
  // A body that stays away, or a rig that was moved, is not to hold up all frames.
  constexpr int kLongestWait = 31;  // frames between two searches
  // Of forces near many candidates a few act.
  constexpr int kFewForces = 6;  // components
  const int components = estimator_.num_components();
  const int least = (locator_ ? std::min(components, kFewForces) : components) + 2;
  // Right answers take 5 to 15 factorisations each.
  constexpr int kMostOfOne = 20, kMostOfAll = 60;
  int left = kMostOfAll;
  for (const CameraDetections& camera : detections) {
    if (static_cast<int>(camera.dots.size()) < least) return std::nullopt;
  }
  if (search_.frames_to_wait-- > 0) return std::nullopt;
  search_.next_wait = std::min(2 * search_.next_wait + 1, kLongestWait);
  search_.frames_to_wait = search_.next_wait;
  struct Answer {
    Attempt attempt;
    estimation::ForceEstimator::Memory memory;
    Eigen::Matrix3Xd markers;  // m
  };
  std::vector<Answer> answers;
  estimator_.LimitFactorisations(kMostOfOne);
  const estimation::ForceEstimator::Memory before = estimator_.Remember();
  for (const bool unloaded : {false, true}) {
    estimator_.Recall(before);
    if (unloaded) {
      const auto n = estimator_.num_components();
      if (!estimator_.StartFrom(Eigen::VectorXd::Zero(n), actuation).ok()) continue;
    } else if (!estimator_.Advance(actuation).ok()) {
      continue;
    }
    const estimation::ForceEstimator::Memory start = estimator_.Remember();
    const Eigen::VectorXd about = start.loads.head(estimator_.num_components());
    const Eigen::MatrixXd intensities =
        unloaded ? Eigen::MatrixXd((kUnloaded * Walk(Linearise())).asDiagonal())
                 : Eigen::MatrixXd(kWiden * intensity_covariance_);
    for (Allocated& proposal : Propose(detections, intensities)) {
      estimator_.Recall(start);
      proposal.intensity = about;
      constexpr double kNoThreshold = 0;
      if (left <= 0) break;
      Attempt attempt = Settle(std::move(proposal), detections, kNoThreshold, actuation, true);
      left -= attempt.estimate.factorisations;
      const int used = attempt.used();
      if (!attempt.estimate.ok() || used < least) continue;
      if (attempt.rejected() > kMaxRejected * static_cast<double>(attempt.observations.size())) {
        continue;
      }
      Eigen::Matrix3Xd markers(3, world_.markers.size());
      const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
      for (Eigen::Index m = 0; m < markers.cols(); ++m) {
        markers.col(m) = world_.markers[m].weights.Apply(x);
      }
      answers.push_back({std::move(attempt), estimator_.Remember(), std::move(markers)});
    }
  }
  estimator_.LimitFactorisations(options_.estimator.max_factorisations);
  estimator_.Recall(before);
  const auto best = std::max_element(
      answers.begin(), answers.end(),
      [](const auto& a, const auto& b) { return a.attempt.used() < b.attempt.used(); });
  if (best == answers.end()) return std::nullopt;
  for (const Answer& other : answers) {
    const double apart = (other.markers - best->markers).colwise().norm().maxCoeff();
    if (apart > kAlike * world_.marker_spacing &&
        other.attempt.used() > kLead * best->attempt.used()) {
      return std::nullopt;
    }
  }
  estimator_.Recall(best->memory);
  estimator_.Advance(actuation);  // for the response there
  return std::move(best->attempt);
}

}  // namespace softforce::pipeline
