#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "softforce/estimation/observation.h"
#include "softforce/fem/static_solver.h"
#include "softforce/geometry/rigid.h"

namespace softforce::estimation {

enum class EstimationMethod {
  kConverged,  // Gauss–Newton on the converged equilibrium
  // One linear step per frame as in the paper (eqs. 3–13), for comparison: plain least squares on
  // the measured points without whitening, model error, offset, prior or rejection, and the body
  // follows along its compliance.
  kLinearStep
};

// The name of a method in options and files: "converged", "linear".
const char* Name(EstimationMethod method);

struct EstimatorOptions {
  EstimationMethod method = EstimationMethod::kConverged;
  // What the finite element model gets wrong (standard deviations), as shares of the largest
  // displacement among the observed points. One part moves all points together like a rigid body: a
  // mesh too stiff at its supports, supports that give way, a rig that shifted. It is estimated
  // along with the forces (see ForceEstimate::offset). The other part differs from point to point
  // and is added to the covariance of each.
  double common_model_error = 0.005;
  double local_model_error = 0.002;
  // N, standard deviation of how far a force component may go from one frame to the next: a prior
  // about the last usable estimate, whose covariance grows by it with every frame. Infinite: each
  // frame stands for itself.
  double force_walk = std::numeric_limits<double>::infinity();
  // N, standard deviation of every force component about 0: a prior in each frame, with which
  // forces that the observations cannot tell apart are shared out. Infinite: none.
  double force_scale = std::numeric_limits<double>::infinity();
  double loss_scale = 4;  // whitened distance beyond which the loss grows only linearly (Huber)
  double rejection_probability = 1e-4;  // a right observation is rejected after the fit this often
  double max_rejected_share = 1.0 / 3;  // of the observations
  double min_singular_ratio =
      1e-6;                 // of the whitened compliance; below: forces cannot be told apart
  int max_iterations = 30;  // of a fit
  // Of the tangent, while one frame is fitted: beyond, it is given up as not converged, so that a
  // frame with wrong observations does not hold up those after it.
  int max_factorisations = 100;
  // Converged when neither the estimate nor any observed point would move by more than so many of
  // its standard deviations.
  double tolerance = 0.1;
  double max_staleness =
      3e-3;  // m, how far the body may move before the compliance is computed anew: 1 % of an sd

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
    kInconsistent,  // too many observations are impossible
    kInvalidInput   // bounds that exclude each other, commands that no actuator can follow
  };

  Status status = Status::kNotRun;
  std::string reason;         // for a person; empty if ok
  Eigen::VectorXd intensity;  // N, per component in the order of sites and their directions
  // N², of the intensities as if there were no bounds, the uncertain actuators and the offset being
  // unknown along with them.
  Eigen::MatrixXd covariance;
  // Per actuator, cables then chambers: what it does less what it was told (N, m or Pa), and the
  // standard deviation of that. Zero for those that are known exactly.
  Eigen::VectorXd actuator_change, actuator_sd;
  RigidOffset offset;
  double chi2 = NAN;  // whitened squared misfit of the observations used
  int degrees_of_freedom = 0;
  std::vector<char> rejected;  // per observation: impossible after the fit, and not used
  int iterations = 0;          // linear fits
  int factorisations = 0;      // of the tangent

  bool ok() const { return status == Status::kOk; }
  std::string BriefReport() const;
};

const char* Name(ForceEstimate::Status status);

// Finds the intensities λ of external forces at known places (paper IV) from where points of the
// body were seen:
//
//   min over λ, a, ξ of  Σ_i ρ(|R_i^(-1/2) (x_i(λ, a) + offset_i(ξ) − z_i)|²)
//                        + ξᵀ P⁻¹ ξ + aᵀ A⁻¹ a + (λ − λ_last)ᵀ L⁻¹ (λ − λ_last),
//   with lower ≤ λ ≤ upper, and no cable pushing,
//
// x(λ, a) being the equilibrium under λ and the actuation; a what uncertain actuators do beyond
// what they were told, with prior variances A (none: Remark 3); ξ a rigid offset with prior
// covariance P; λ_last, L the last estimate and its covariance, grown by the random walk.
// R_i is the measurement's covariance plus the local model error; P is where the rig's place is
// uncertain plus the common model error; ρ is Huber's loss.
//
// Gauss–Newton: the body is linearised where it stands, with the Jacobian R^(-1/2) W_ef of its
// tangent; Ceres solves the robust linear problem; the body takes a step towards the equilibrium
// under the new loads; and so on until neither moves (the paper takes one linear step, eqs. 9–13).
// Body and forces converge together, so that a frame costs little more than one equilibrium. After
// the fit, observations whose misfit is impossible are rejected and the rest is fitted again. The
// estimate is warm-started from the last one. Observations that are not finite, or absurdly far
// from the body, are rejected from the start.
class ForceEstimator {
 public:
  // `solver` must outlive the estimator. `actuators`: one uncertainty per cable, then per chamber;
  // empty: all are known exactly.
  ForceEstimator(fem::StaticSolver* solver, std::vector<ForceSite> sites,
                 const EstimatorOptions& options = {},
                 const std::vector<ActuatorUncertainty>& actuators = {});
  ~ForceEstimator();
  ForceEstimator(ForceEstimator&&) noexcept;

  int num_components() const;
  const std::vector<ForceSite>& sites() const;

  // Moves the body to a new actuation under the last forces, without observations; by the linear
  // method it stays where it is. Not run for an actuation that Estimate would refuse.
  fem::SolveSummary Advance(const fem::Actuation& actuation);

  // How uncertain the place of the rig is: covariance of a twist xi (translation in m, rotation in
  // rad) of the robot frame, T_rig_robot = estimate · ExpSe3(xi). Zero until it is set.
  void SetRegistrationCovariance(const geometry::Matrix6d& covariance);

  // N, the range of a site's intensities from the next frame on.
  void SetBounds(int site, double lowest, double highest);

  // Estimates the forces under the given actuation. If the status is not kOk the state stays as it
  // was before; a linear step that led where there is no next one goes back to rest.
  ForceEstimate Estimate(const std::vector<Observation>& observations,
                         const fem::Actuation& actuation);

  // The same frame once more, from other observations of it: the body starts where the last
  // estimate has brought it, and what was known before the frame counts once. If the status is not
  // kOk the state is that before the frame.
  ForceEstimate EstimateAgain(const std::vector<Observation>& observations,
                              const fem::Actuation& actuation);

  // All that it remembers of the frames so far.
  struct Memory {
    fem::Equilibrium body;
    Eigen::VectorXd loads;       // N, m or Pa, that the body is under
    Eigen::VectorXd intensity;   // N, last usable
    Eigen::MatrixXd covariance;  // N², of that with the walk since
  };
  Memory Remember() const;
  void Recall(const Memory& memory);

  // Takes the body to the equilibrium under other forces, for the next estimate to start there.
  fem::SolveSummary StartFrom(const Eigen::VectorXd& intensity, const fem::Actuation& actuation);

  // See EstimatorOptions::max_factorisations; from the next estimate on.
  void LimitFactorisations(int most);

  const fem::Equilibrium& state() const;
  const Eigen::VectorXd& intensity() const;  // N, last usable

  // ∂(position of a point)/∂λ, 3×components, m/N: rows of W_ef at the current state, as last
  // factorised.
  // Call Advance or Estimate first.
  Eigen::Matrix3Xd Compliance(const mesh::NodalWeights& at) const;

  // The force on a site in newtons, and the covariance of its three components.
  Eigen::Vector3d Force(const Eigen::VectorXd& intensity, int site) const;
  Eigen::Matrix3d ForceCovariance(const Eigen::MatrixXd& covariance, int site) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::estimation
