#pragma once

#include <memory>
#include <string>
#include <vector>

#include "softforce/estimation/location_estimator.h"
#include "softforce/pipeline/frame_result.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// Finds forces near the scene's candidates, with a body of its own: that of the tracker follows the
// markers.
class ForceLocator {
 public:
  // Scene and world must outlive it. Throws InputError for actuators that are not known exactly.
  ForceLocator(const scene::Scene& scene, const World& world,
               const estimation::LocationOptions& options);

  void SetRegistrationCovariance(const geometry::Matrix6d& covariance) {
    estimator_->SetRegistrationCovariance(covariance);
  }

  fem::SolveSummary Advance(const fem::Actuation& actuation) {
    return estimator_->Advance(actuation);
  }

  // `shape`: of a body that follows the markers, see LocationEstimator.
  estimation::LocationEstimate Estimate(const std::vector<estimation::Observation>& observations,
                                        const fem::Actuation& actuation,
                                        const fem::Equilibrium& shape) {
    return estimator_->Estimate(observations, actuation, &shape);
  }

  const fem::Equilibrium& state() const { return estimator_->state(); }

  std::vector<ForceResult> Results(const estimation::LocationEstimate& estimate) const;

 private:
  const scene::Scene& scene_;
  const World& world_;
  std::unique_ptr<fem::StaticSolver> solver_;
  std::unique_ptr<estimation::LocationEstimator> estimator_;
};

// What the tracker of such a body estimates from frame to frame, to know where its markers are:
// forces in all directions on all candidates, with a prior about none, and with as much local model
// error as forces between the candidates cause.
std::vector<estimation::ForceSite> FollowingSites(const World& world);
estimation::EstimatorOptions FollowingOptions(const World& world,
                                              estimation::EstimatorOptions options);

}  // namespace softforce::pipeline
