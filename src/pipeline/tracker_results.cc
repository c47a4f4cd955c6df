// The tracker's half that says what came of a frame.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pipeline/by_twist.h"
#include "pipeline/camera_view.h"
#include "pipeline/force_locator.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {

void Tracker::AddActuators(const fem::Actuation& actuation, FrameResult* result) const {
  for (size_t c = 0; c < world_.solver->body().cables.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    result->cables.push_back(
        {world_.solver->body().cables[c].name, state().tension(i), state().shortening(i)});
  }
  for (size_t k = 0; k < actuation.pressures.size(); ++k) {
    result->chambers.push_back(
        {world_.solver->body().chambers[k].name, state().load.actuation.pressures[k]});
  }
}

std::vector<ForceResult> Tracker::ForceResults(const estimation::ForceEstimate& estimate) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  std::vector<ForceResult> forces;
  forces.reserve(world_.sites.size());
  for (int s = 0; s < static_cast<int>(world_.sites.size()); ++s) {
    forces.push_back({s, scene_.forces.candidates[s].id, world_.sites[s].at.Apply(x),
                      world_.sites[s].at.Apply(world_.mesh().nodes),
                      estimator_.Force(estimate.intensity, s),
                      estimator_.ForceCovariance(estimate.covariance, s)});
  }
  return forces;
}

void Tracker::TellWhatIsAbsent(std::vector<MarkerResult>* markers) const {
  if (rig_.cameras.empty()) return;
  for (MarkerResult& marker : *markers) marker.expected_absent = true;
  const std::vector<MovingFeature> moving = Linearise();
  for (size_t f = 0; f < moving.size(); ++f) {
    for (int c = 0; c < static_cast<int>(rig_.cameras.size()); ++c) {
      if (!IsExpected(c, rig_.cameras[c], T_rig_robot_, moving[f].at, options_.observe)) continue;
      (*markers)[features_.features()[f].marker].expected_absent = false;
    }
  }
}

void Tracker::LocateForces(const fem::Actuation& actuation, FrameResult* result,
                           std::vector<char>* rejected) {
  std::vector<estimation::Observation> observations;
  std::vector<int> features;
  for (const MarkerObservation& seen : observations_) {
    if ((*rejected)[seen.feature]) continue;
    observations.push_back(seen.seen);
    features.push_back(seen.feature);
  }
  const estimation::LocationEstimate located =
      locator_->Estimate(observations, actuation, estimator_.state());
  result->status = located.status;
  result->reason = located.reason;
  result->chi2 = located.chi2;
  result->degrees_of_freedom = located.degrees_of_freedom;
  if (!located.ok()) return;
  for (size_t i = 0; i < features.size(); ++i) {
    if (located.rejected[i]) (*rejected)[features[i]] = 1;
  }
  result->forces = locator_->Results(located);
  result->probability = located.probability;
}

// A dot is its only feature. A tag is measured by its corners: its centre is where the model has
// it, moved by the mean misfit of the corners, since the surface between them is curved.
std::vector<MarkerResult> Tracker::MarkerResults(
    const std::vector<FeatureObservation>& observations, const std::vector<char>& rejected) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + state().u;
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

// Where a marker is by all that was seen of the others. What the model gets wrong in each place by
// itself is taken from the frame: the misfit that its forces leave says how large that is.
void Tracker::ExpectMarkers(const std::vector<FeatureObservation>& located,
                            const std::vector<char>& rejected, std::vector<MarkerResult>* markers) {
  const int n = estimator_.num_components();
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  const std::vector<MovingFeature> features = Linearise();
  // The forces are known by this frame's observations, nearly alone.
  constexpr double kDiffuse = 100;
  const Eigen::MatrixXd prior =
      SharedCovariance(kDiffuse * intensity_covariance_) +
      1e-18 * Eigen::MatrixXd::Identity(n + 6, n + 6);  // so that nothing is known exactly
  const Eigen::MatrixXd prior_information = prior.inverse();
  const double floor = std::pow(options_.region_floor, 2);
  double own = std::max(own_variance_, floor);
  Eigen::VectorXd delta;
  Eigen::MatrixXd covariance;
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd of_data = Eigen::MatrixXd::Zero(n + 6, n + 6);
    Eigen::VectorXd weighted = Eigen::VectorXd::Zero(n + 6);
    double squares = 0, slope = 0;  // the slope is 1/m², of the expected squares by `own`
    int rows = 0;
    for (size_t f = 0; f < located.size(); ++f) {
      if (located[f].whitening.rows() == 0 || rejected[f]) continue;
      const Eigen::MatrixXd W = located[f].whitening;
      const Eigen::MatrixXd A = W * features[f].jacobian;
      const Eigen::VectorXd misfit = W * (located[f].position - features[f].at.position);
      const Eigen::MatrixXd R =
          Eigen::MatrixXd::Identity(W.rows(), W.rows()) + own * W * W.transpose();
      const Eigen::MatrixXd inverse = R.inverse();
      const Eigen::MatrixXd weight = inverse * A;
      of_data += A.transpose() * weight;
      weighted += weight.transpose() * misfit;
      squares += misfit.dot(inverse * misfit);
      slope += (inverse * W * W.transpose()).trace();
      rows += static_cast<int>(W.rows());
    }
    const Eigen::LLT<Eigen::MatrixXd> llt(prior_information + of_data);
    delta = llt.solve(weighted);
    covariance = llt.solve(Eigen::MatrixXd::Identity(n + 6, n + 6));
    // What the fit leaves, and what it would leave if `own` were right.
    const double left = squares - 2 * weighted.dot(delta) + delta.dot(of_data * delta);
    const double freedom = rows - (covariance * of_data).trace();
    if (!(freedom > 1) || !(slope > 0)) break;
    const double found = own + (left - freedom) * rows / (slope * freedom);
    // A frame says little about it by itself, unless it is clearly larger.
    constexpr double kFrames = 10, kClearly = 3;  // the latter in standard deviations
    const bool clearly = left - freedom > kClearly * std::sqrt(2 * freedom);
    if (!clearly || round == kRounds - 1) {
      own_variance_ += (found - own_variance_) / kFrames;
      break;
    }
    own = std::max(found, floor);
  }
  for (size_t m = 0; m < markers->size(); ++m) {
    MarkerResult& marker = (*markers)[m];
    // Where the body stands that follows the markers.
    const Eigen::Vector3d on_body = world_.markers[m].weights.Apply(x) + world_.markers[m].offset;
    Eigen::Matrix3Xd jacobian(3, n + 6);
    jacobian << estimator_.Compliance(world_.markers[m].weights), ByTwist(on_body);
    marker.expected = on_body + jacobian * delta;
    marker.expected_covariance =
        jacobian * covariance * jacobian.transpose() + own * Eigen::Matrix3d::Identity();
  }
}

}  // namespace softforce::pipeline
