#include "pipeline/force_locator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/actuators.h"
#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

// A force as large as the prior's standard deviation moves a marker by this share of the body.
constexpr double kExpectedMotion = 0.25;
// Of the largest displacement: what a force between two candidates moves differently from two
// forces on them.
constexpr double kBetweenCandidates = 0.02;

estimation::LocationCandidate CandidateOf(const scene::Candidate& candidate, const BodyPoint& at) {
  estimation::LocationCandidate result;
  result.name = std::to_string(candidate.id);
  result.at = at.at;
  switch (candidate.direction) {
    case scene::ForceDirection::kFree:
      result.direction = estimation::ForceDirection::kFree;
      break;
    case scene::ForceDirection::kNormal:
      result.direction = estimation::ForceDirection::kPush;
      break;
    case scene::ForceDirection::kFixed:
      result.direction = estimation::ForceDirection::kFixed;
      result.fixed = candidate.fixed_direction;
      break;
  }
  return result;
}

}  // namespace

ForceLocator::ForceLocator(const scene::Scene& scene, const World& world,
                           const estimation::LocationOptions& options)
    : scene_(scene), world_(world) {
  const std::string file = scene.file.string();
  for (const estimation::ActuatorUncertainty uncertainty : Uncertainties(scene)) {
    if (uncertainty == 0) continue;
    throw base::InputError(file + ": actuators: uncertainty",
                           "cannot go with 'known: false': places are found with actuators that "
                           "do what they are told",
                           "Leave it out, or find cables' offsets with softforce identify.");
  }
  solver_ = std::make_unique<fem::StaticSolver>(world.solver->body(), file + ": body");
  std::vector<estimation::LocationCandidate> candidates;
  for (const scene::Candidate& candidate : scene.forces.candidates) {
    const std::string where = fmt::format("{}: forces: candidates: id {}", file, candidate.id);
    candidates.push_back(CandidateOf(
        candidate, PlaceOnSurface(world.surface, world.mesh().nodes, candidate.position, where)));
  }
  estimation::LocationOptions with_patch = options;
  with_patch.patch = scene.forces.patch;
  estimator_ = std::make_unique<estimation::LocationEstimator>(solver_.get(), world.surface,
                                                               std::move(candidates), with_patch);
}

std::vector<ForceResult> ForceLocator::Results(const estimation::LocationEstimate& estimate) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + state().u;
  std::vector<ForceResult> results;
  for (const estimation::LocatedForce& force : estimate.forces) {
    ForceResult result;
    result.identity = force.identity;
    result.candidate = scene_.forces.candidates[force.candidate].id;
    result.position = mesh::Position(world_.surface, x, force.at);
    result.rest = force.rest;
    result.force = force.force;
    result.covariance = force.covariance;
    result.place_covariance =
        force.tangents * force.location_covariance * force.tangents.transpose();
    for (const int c : force.alternatives) {
      result.alternatives.push_back(scene_.forces.candidates[c].id);
    }
    results.push_back(result);
  }
  return results;
}

std::vector<estimation::ForceSite> FollowingSites(const World& world) {
  std::vector<estimation::ForceSite> sites = world.sites;
  for (estimation::ForceSite& site : sites) {
    site.directions = Eigen::Matrix3d::Identity();
    site.lowest = -INFINITY;
    site.highest = INFINITY;
  }
  return sites;
}

estimation::EstimatorOptions FollowingOptions(const World& world,
                                              estimation::EstimatorOptions options) {
  estimation::ForceEstimator at_rest(world.solver.get(), FollowingSites(world), options);
  at_rest.Advance(fem::NoActuation(world.solver->body()));
  double softest = 0;  // m/N
  for (const BodyPoint& marker : world.markers) {
    softest = std::max(softest, at_rest.Compliance(marker.weights).colwise().norm().maxCoeff());
  }
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  const double size = (X.rowwise().maxCoeff() - X.rowwise().minCoeff()).norm();
  if (softest > 0) options.force_scale = kExpectedMotion * size / softest;
  options.local_model_error = std::max(options.local_model_error, kBetweenCandidates);
  return options;
}

}  // namespace softforce::pipeline
