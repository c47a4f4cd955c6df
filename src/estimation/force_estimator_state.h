#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimation/loaded_body.h"
#include "estimation/model_error.h"
#include "estimation/robust_fit.h"
#include "softforce/estimation/force_estimator.h"

namespace softforce::estimation {

// Diagonals from the body: no camera sees that far.
inline constexpr double kAbsurdDistance = 100;

// What a ForceEstimator holds. Parameters of a fit: the body's loads (see LoadedBody), then the six
// of the rigid offset.
struct ForceEstimator::State {
  State(fem::StaticSolver* solver_in, std::vector<ForceSite> sites_in,
        const EstimatorOptions& options_in, std::vector<ActuatorUncertainty> actuators_in);

  int num_components() const { return body.num_components(); }
  int num_loads() const { return body.num_loads(); }
  int FirstComponent(int site) const;
  Eigen::VectorXd intensity() const { return body.pose().loads.head(num_components()); }

  // Why the frame's bounds or actuation cannot be; empty if they can.
  std::string InputProblem(const fem::Actuation& told) const;
  // Of the parameters: the sites' bounds, and tensions that do not push.
  Bounds ParameterBounds(const fem::Actuation& told) const;
  // Loads within the bounds, closest to those at hand.
  Eigen::VectorXd AllowedLoads(const Bounds& bounds) const;
  // Names of what a unit vector of loads is made of, for a person.
  std::string NamesIn(const Eigen::VectorXd& combination) const;

  // Brings the body near the equilibrium under given loads, unless it is there.
  fem::SolveSummary MoveTo(const Eigen::VectorXd& loads, const fem::Actuation& told);

  bool IsPossible(const Observation& observation) const;
  double LargestDisplacement(const std::vector<Observation>& observations) const;  // m, now
  // How far the points were seen from their place at rest, m: of so many the furthest that all
  // that may be rejected do not matter.
  double SeenDisplacement(const std::vector<Observation>& observations) const;
  std::vector<WhitenedObservation> WhitenAll(const std::vector<Observation>& observations,
                                             double displacement, ForceEstimate* estimate) const;

  // The residuals linearised where the body stands: observations, offset's prior, the others.
  std::vector<ResidualBlock> Linearise(const std::vector<WhitenedObservation>& used,
                                       const OffsetPrior& prior, const Eigen::VectorXd& parameters,
                                       LoadedBody::Of response = LoadedBody::Of::kStep) const;

  ForceEstimate Converge(const std::vector<Observation>& observations, const fem::Actuation& told);
  ForceEstimate FitAndReject(const std::vector<Observation>& observations, double displacement,
                             const fem::Actuation& told);
  // Fits; sets the parameters, the linearised residuals there, and status kOk or why not.
  void Fit(const std::vector<WhitenedObservation>& used, const OffsetPrior& prior,
           const fem::Actuation& told, Eigen::VectorXd* parameters,
           std::vector<ResidualBlock>* blocks, ForceEstimate* estimate);
  // `step` of the parameters, where the linear answer may be believed that far; else a shorter one.
  Eigen::VectorXd CarefulStep(const std::vector<WhitenedObservation>& used,
                              const std::vector<ResidualBlock>& blocks,
                              const Eigen::VectorXd& parameters, const Eigen::VectorXd& step,
                              const Bounds& bounds) const;
  // Theorem 2: whether the observations determine every load; else the status says which not.
  bool AreLoadsObservable(const std::vector<ResidualBlock>& blocks, ForceEstimate* estimate) const;
  void Conclude(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& parameters,
                ForceEstimate* estimate) const;

  // The paper's single step.
  ForceEstimate StepLinearly(const std::vector<Observation>& observations,
                             const fem::Actuation& told);

  fem::StaticSolver* solver;
  std::vector<ForceSite> sites;
  EstimatorOptions options;
  std::vector<ActuatorUncertainty> actuators;
  geometry::Matrix6d registration_covariance = geometry::Matrix6d::Zero();
  LoadedBody body;
  LoadedBody::Pose at_rest;
  double diagonal = NAN;      // m, of the body at rest
  int factorised_before = 0;  // by the body, before the frame at hand was fitted

  ForceEstimate EstimateFrame(const std::vector<Observation>& observations,
                              const fem::Actuation& told);

  Eigen::VectorXd last_intensity;   // N, of the last usable estimate
  Eigen::MatrixXd walk_covariance;  // N², of the forces about it by now; empty before the first
  ForceEstimator::Memory before_frame;
};

// Spreads a covariance given per load over the actuators, see ForceEstimate.
void SetActuators(const LoadedBody& body, int num_actuators, const Eigen::VectorXd& loads,
                  const Eigen::MatrixXd& covariance, ForceEstimate* estimate);

}  // namespace softforce::estimation
