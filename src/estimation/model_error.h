#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/estimation/observation.h"
#include "softforce/geometry/rigid.h"

namespace softforce::estimation {

// An observation prepared for a fit: what the model predicts for it is at·x + offset.
struct WhitenedObservation {
  int index = -1;  // among the caller's observations
  const Observation* observation = nullptr;
  Whitening whitening;  // with the model's local error included
  double sd = NAN;      // m, the smallest along any axis
};

// Adds to the measurement's noise the model's local error (`model_sd`, m), which `companions`
// observations of one marker, this one included, have in common.
WhitenedObservation Whiten(const Observation& observation, int index, double model_sd,
                           int companions);

// How many of the observations are of the same marker as each.
std::vector<int> CountCompanions(const std::vector<Observation>& observations);

// The small rigid motion of what was measured against the model: translation (m), then rotation
// (rad) about `centre`. Its prior has mean zero and covariance P.
struct OffsetPrior {
  Eigen::Vector3d centre;        // m, mean of the observed points
  geometry::Matrix6d whitening;  // P^(-1/2)
};

// Where the observed points are when the nodes stand at `x`.
struct PointCloud {
  Eigen::Vector3d centre;  // m
  double extent;           // m, root mean square distance from the centre
};
PointCloud CloudOf(const std::vector<WhitenedObservation>& observations, const Eigen::Matrix3Xd& x);

// P of an offset about the centre: where the rig's place is uncertain (`registration`: covariance
// of a twist at the robot's origin), and a common error of the model that shifts the points by
// `model_sd` (m), and turns them by as much.
geometry::Matrix6d OffsetCovariance(const PointCloud& cloud, const geometry::Matrix6d& registration,
                                    double model_sd);

OffsetPrior MakeOffsetPrior(const std::vector<WhitenedObservation>& observations,
                            const Eigen::Matrix3Xd& x, const geometry::Matrix6d& registration,
                            double model_sd);

// The observed point's position on the model (m) less its measurement, moved by an offset.
Eigen::Vector3d Misfit(const Observation& observation, const Eigen::Vector3d& on_model,
                       const OffsetPrior& prior, const geometry::Vector6d& offset);
// ∂ misfit/∂ offset.
Eigen::Matrix<double, 3, 6> OffsetJacobian(const Eigen::Vector3d& on_model,
                                           const OffsetPrior& prior);

}  // namespace softforce::estimation
