// The tracker's way back after frames that it could not understand.
#include <algorithm>
#include <limits>

#include "pipeline/shape_memory.h"
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

std::vector<Tracker::Beginning> Tracker::Beginnings(
    const std::vector<CameraDetections>& detections) const {
  constexpr size_t kMostShapes = 4;
  std::vector<Beginning> beginnings;
  for (const Shape* shape :
       shapes_->Resembling(rig_, T_rig_robot_, detections, options_.observe, looks_, kMostShapes)) {
    beginnings.push_back({Beginning::At::kShape, &shape->state});
  }
  beginnings.push_back({Beginning::At::kLastState});
  beginnings.push_back({Beginning::At::kUnloaded});
  return beginnings;
}

bool Tracker::Begin(const Beginning& beginning, const fem::Actuation& actuation) {
  if (beginning.at == Beginning::At::kUnloaded) {
    const auto n = estimator_.num_components();
    return estimator_.StartFrom(Eigen::VectorXd::Zero(n), actuation).ok();
  }
  if (beginning.at == Beginning::At::kShape) {
    estimation::ForceEstimator::Memory there = estimator_.Remember();
    there.body = beginning.state->body;
    there.loads = beginning.state->loads;
    estimator_.Recall(there);
  }
  return estimator_.Advance(actuation).ok();
}

int Tracker::Allocated::held() const {
  return static_cast<int>(
      std::count_if(located.begin(), located.end(),
                    [](const FeatureObservation& seen) { return seen.position.allFinite(); }));
}

// All that the beginnings propose, those that hold the most features first. What says the same as
// another is left out, whichever it began at.
std::vector<Tracker::Proposal> Tracker::ProposeAll(const std::vector<CameraDetections>& detections,
                                                   const fem::Actuation& actuation) {
  constexpr double kWiden = 4;      // of variances, about the last state
  constexpr double kUnloaded = 36;  // walks' variances, about the unloaded body
  constexpr double kNearShape = 4;  // walks' variances, about a shape it had
  std::vector<Proposal> proposals;
  const auto known = [&](const Allocated& allocated) {
    return std::any_of(proposals.begin(), proposals.end(), [&](const Proposal& other) {
      return other.allocated.sightings.dots == allocated.sightings.dots;
    });
  };
  const estimation::ForceEstimator::Memory before = estimator_.Remember();
  for (const Beginning& beginning : Beginnings(detections)) {
    estimator_.Recall(before);
    if (!Begin(beginning, actuation)) continue;
    const auto start =
        std::make_shared<const estimation::ForceEstimator::Memory>(estimator_.Remember());
    Eigen::MatrixXd intensities = kWiden * intensity_covariance_;
    if (beginning.at != Beginning::At::kLastState) {
      const double walks = beginning.at == Beginning::At::kUnloaded ? kUnloaded : kNearShape;
      intensities = (walks * Walk(Linearise())).asDiagonal();
    }
    for (Allocated& allocated : Propose(detections, intensities)) {
      if (known(allocated)) continue;
      allocated.intensity = start->loads.head(estimator_.num_components());
      proposals.push_back({std::move(allocated), start});
    }
  }
  estimator_.Recall(before);
  std::stable_sort(proposals.begin(), proposals.end(), [](const Proposal& a, const Proposal& b) {
    return a.allocated.held() > b.allocated.held();
  });
  return proposals;
}

// m, of the body's state.
Eigen::Matrix3Xd Tracker::MarkersNow() const {
  Eigen::Matrix3Xd markers(3, world_.markers.size());
  const Eigen::Matrix3Xd x = world_.mesh().nodes + estimator_.state().u;
  for (Eigen::Index m = 0; m < markers.cols(); ++m) {
    markers.col(m) = world_.markers[m].weights.Apply(x);
  }
  return markers;
}

// After a search in vain the next 1, 3, 7 … 31 frames go without: a body that stays away, or a rig
// that was moved, is not to hold up all frames.
bool Tracker::MaySearch() {
  constexpr int kLongestWait = 31;  // frames between two searches
  if (search_.frames_to_wait-- > 0) return false;
  search_.next_wait = std::min(2 * search_.next_wait + 1, kLongestWait);
  search_.frames_to_wait = search_.next_wait;
  return true;
}

// Looks about shapes that the body had before, further about where it was last, and about where it
// is without forces. What is proposed there is only believed if the forces explain it nearly
// without rejections, and if nothing that differs explains nearly as much: a frame left out is
// better than markers mixed up.
std::optional<Tracker::Attempt> Tracker::SearchWidely(
    const std::vector<CameraDetections>& detections, const fem::Actuation& actuation) {
  constexpr double kMaxRejected = 0.2;  // of the observations
  constexpr double kLead = 0.8;         // a rival has less than this share of the observations
  constexpr double kAlike = 0.25;       // spacings, between the markers of two answers
  constexpr double kHopeless = 0.6;     // of the best answer's: no rival comes of a proposal below
  constexpr double kNoThreshold = 0;
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
  if (!MaySearch()) return std::nullopt;
  struct Answer {
    Attempt attempt;
    estimation::ForceEstimator::Memory memory;
    Eigen::Matrix3Xd markers;  // m
  };
  std::vector<Answer> answers;
  int most = 0;  // observations that an answer explains
  estimator_.LimitFactorisations(kMostOfOne);
  const estimation::ForceEstimator::Memory before = estimator_.Remember();
  for (Proposal& proposal : ProposeAll(detections, actuation)) {
    if (left <= 0 || proposal.allocated.held() < std::max<double>(least, kHopeless * most)) break;
    estimator_.Recall(*proposal.start);
    Attempt attempt =
        Settle(std::move(proposal.allocated), detections, kNoThreshold, actuation, true);
    left -= attempt.estimate.factorisations;
    if (!attempt.estimate.ok() || attempt.used() < least) continue;
    if (attempt.rejected() > kMaxRejected * static_cast<double>(attempt.observations.size())) {
      continue;
    }
    most = std::max(most, attempt.used());
    answers.push_back({std::move(attempt), estimator_.Remember(), MarkersNow()});
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
