#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "softforce/fem/static_solver.h"
#include "softforce/geometry/rigid.h"

namespace softforce::estimation {

// A place where an external force acts, and the directions that it may have there.
struct ForceSite {
  std::string name;       // for messages
  mesh::NodalWeights at;  // the mean over its patch
  Eigen::Matrix3Xd
      directions;  // orthonormal columns: 3×1 for a known direction, 3×3 for a free one
};

// Where a point of the body was measured to be.
struct Observation {
  mesh::NodalWeights at;                             // the point, as a mean of nodes
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // m, measured point − that mean, body at rest
  Eigen::Vector3d position = Eigen::Vector3d::Constant(NAN);  // m, robot frame
  // k×3 with k = 3, or 2 where only one camera sees the point: whitening · (model − position) has
  // unit covariance for the measurement's own noise (1/m).
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> whitening;
};

struct EstimatorOptions {
  // What the finite element model gets wrong (standard deviations), as shares of the largest
  // displacement among the observed points. One part moves all points together like a rigid body: a
  // mesh too stiff at its supports, supports that give way, a rig that shifted. It is estimated
  // along with the forces (see ForceEstimate::offset). The other part differs from point to point
  // and is added to the covariance of each.
  double common_model_error = 0.01;
  double local_model_error = 0.005;
  double loss_scale = 4;  // whitened distance beyond which the loss grows only linearly (Huber)
  double rejection_probability = 1e-4;  // a right observation is rejected after the fit this often
  double max_rejected_share = 1.0 / 3;  // of the observations
  double min_singular_ratio =
      1e-6;  // of the whitened compliance; below: forces cannot be told apart
  int max_iterations = 30;
  double cost_tolerance = 1e-4;  // converged when a step lowers half of χ² by less than this
  double max_staleness =
      2e-3;  // m, how far the body may move before the compliance is computed anew

  void Check() const;  // throws InputError naming the option
};

// A small rigid motion of what was measured against the model, robot frame: a point p of the body
// is seen at p + translation + rotation × (p − centre), centre being the mean of the observed
// points.
struct RigidOffset {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     // rad
};

struct ForceEstimate {
  enum class Status {
    kNotRun,
    kOk,
    kTooFewObservations,
    kUnobservable,
    kNotConverged,
    kInconsistent  // too many observations are impossible
  };

  Status status = Status::kNotRun;
  std::string reason;          // for a person; empty if ok
  Eigen::VectorXd intensity;   // N, per component in the order of sites and their directions
  Eigen::MatrixXd covariance;  // N²
  RigidOffset offset;
  double chi2 = NAN;  // whitened squared misfit of the observations used
  int degrees_of_freedom = 0;
  std::vector<char> rejected;  // per observation: impossible after the fit, and not used
  int iterations = 0;          // of the least-squares solver
  int factorisations = 0;      // of the tangent

  bool ok() const { return status == Status::kOk; }
  std::string BriefReport() const;
};

const char* Name(ForceEstimate::Status status);

struct BodyResponse;  // private: src/estimation/equilibrium_problem.h
struct OffsetPrior;
struct WhitenedObservation;

// Finds the intensities λ of external forces at known places (paper IV) from where points of the
// body were seen:
//
//   min over λ, ξ of Σ_i ρ(|R_i^(-1/2) (x_i(λ) + offset_i(ξ) − z_i)|²) + ξᵀ P⁻¹ ξ,
//
// x(λ) the equilibrium under λ and the actuation, ξ a rigid offset with prior covariance P,
// by Ceres on the *converged* equilibrium (the paper takes one linear step, eqs. 9–13), with
// Jacobian R^(-1/2) W_ef from the tangent there and a Huber loss ρ. R_i is the measurement's
// covariance plus the local model error; P is where the rig's place is uncertain plus the common
// model error. After the fit, observations whose misfit is impossible are rejected and the rest is
// fitted again. The estimate is warm-started from the last one. Observations that are not finite
// are rejected from the start.
class ForceEstimator {
 public:
  // `solver` must outlive the estimator.
  ForceEstimator(fem::StaticSolver* solver, std::vector<ForceSite> sites,
                 const EstimatorOptions& options = {});

  int num_components() const { return static_cast<int>(H_f_.cols()); }
  const std::vector<ForceSite>& sites() const { return sites_; }

  // Moves the body to a new actuation under the last forces, without observations.
  fem::SolveSummary Advance(const fem::Actuation& actuation);

  // How uncertain the place of the rig is: covariance of a twist xi (translation in m, rotation in
  // rad) of the robot frame, T_rig_robot = estimate · ExpSe3(xi). Zero until it is set.
  void SetRegistrationCovariance(const geometry::Matrix6d& covariance) {
    registration_covariance_ = covariance;
  }

  // Estimates the forces under the given actuation. If the status is not kOk the state stays as it
  // was before.
  ForceEstimate Estimate(const std::vector<Observation>& observations,
                         const fem::Actuation& actuation);

  const fem::Equilibrium& state() const { return state_; }
  const Eigen::VectorXd& intensity() const { return intensity_; }  // N, last usable

  // ∂(position of a point)/∂λ, 3×components, m/N: rows of W_ef at the current state, as last
  // factorised.
  // Call Advance or Estimate first.
  Eigen::Matrix3Xd Compliance(const mesh::NodalWeights& at) const;

  // The force on a site in newtons, and the covariance of its three components.
  Eigen::Vector3d Force(const Eigen::VectorXd& intensity, int site) const;
  Eigen::Matrix3d ForceCovariance(const Eigen::MatrixXd& covariance, int site) const;

 private:
  fem::LoadCase LoadOf(const Eigen::VectorXd& intensity, const fem::Actuation& actuation) const;
  int FirstComponent(int site) const;
  bool RefreshCompliance();  // false if the tangent is not positive definite
  std::string SitesIn(const Eigen::VectorXd& combination) const;  // names, for a person
  BodyResponse Response(const fem::Actuation& actuation, ForceEstimate* estimate);
  double LargestDisplacement(const std::vector<Observation>& observations) const;  // m, now
  std::vector<WhitenedObservation> Whiten(const std::vector<Observation>& observations,
                                          double displacement, ForceEstimate* estimate) const;
  OffsetPrior MakeOffsetPrior(const std::vector<WhitenedObservation>& observations,
                              double model_sd) const;
  // Fits, rejects the worst impossible observation, and fits again, until none is left.
  void FitAndReject(std::vector<WhitenedObservation> used, double common_sd,
                    const fem::Actuation& actuation, ForceEstimate* estimate);
  // Fills in χ² and the whitened Jacobian; returns the worst observation that is impossible, or −1.
  int Assess(const std::vector<WhitenedObservation>& used, const OffsetPrior& prior,
             const BodyResponse& body, const Eigen::VectorXd& parameters, Eigen::MatrixXd* J,
             ForceEstimate* estimate) const;
  void Conclude(const Eigen::MatrixXd& J, const Eigen::VectorXd& parameters,
                ForceEstimate* estimate) const;

  fem::StaticSolver* solver_;
  std::vector<ForceSite> sites_;
  EstimatorOptions options_;
  geometry::Matrix6d registration_covariance_ = geometry::Matrix6d::Zero();
  Eigen::MatrixXd H_f_;  // 3N×components: nodal force per newton of each component
  fem::Equilibrium state_;
  Eigen::VectorXd intensity_;        // N, of the last usable estimate
  Eigen::VectorXd state_intensity_;  // N, that state_ balances; differs while a fit is under way
  Eigen::MatrixXd compliance_;       // 3N×components, m/N, at compliance_u_
  Eigen::Matrix3Xd compliance_u_;
  Eigen::Array<bool, Eigen::Dynamic, 1> compliance_taut_;  // which cables were taut there
};

}  // namespace softforce::estimation
