#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "softforce/estimation/force_estimator.h"

namespace softforce::estimation {

// An observation prepared for the fit: what the model predicts for it is at·x + offset.
struct WhitenedObservation {
  int index = -1;  // among the caller's observations
  const Observation* observation = nullptr;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>
      whitening;  // with the model's local error included
};

// The body as a function of the intensities.
struct BodyResponse {
  // Moves the body to equilibrium under λ; false if it cannot.
  std::function<bool(const Eigen::VectorXd& intensity)> move;
  // Position of a point of the body now, m.
  std::function<Eigen::Vector3d(const mesh::NodalWeights&)> position;
  // Its derivative by λ now, 3×components, m/N.
  std::function<Eigen::Matrix3Xd(const mesh::NodalWeights&)> compliance;
};

// The prior of the rigid offset.
struct OffsetPrior {
  Eigen::Vector3d centre;        // m, of the rotation
  geometry::Matrix6d whitening;  // P^(-1/2)
};

// Intensities (N) followed by the offset's translation (m) and rotation (rad): what is fitted.
struct FitResult {
  bool converged = false;
  Eigen::VectorXd parameters;
  int iterations = 0;
  std::string message;
};

// ∂(observed position)/∂(parameters), 3×(components + 6).
Eigen::Matrix3Xd ParameterJacobian(const BodyResponse& body, const OffsetPrior& prior,
                                   const Observation& observation);

// Model's position of an observed point less its measurement, m.
Eigen::Vector3d Misfit(const BodyResponse& body, const OffsetPrior& prior,
                       const Observation& observation, const Eigen::VectorXd& parameters);

// Minimises the robust whitened misfit with Ceres. Each evaluation first moves the body to its
// equilibrium, so residuals and Jacobian belong to a converged state.
FitResult FitParameters(const std::vector<WhitenedObservation>& observations,
                        const Eigen::VectorXd& start, const OffsetPrior& prior,
                        const BodyResponse& body, const EstimatorOptions& options);

}  // namespace softforce::estimation
