#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "softforce/estimation/observation.h"
#include "softforce/fem/static_solver.h"

namespace softforce::estimation {

// The body as a function of the loads that are looked for: the intensities of the forces (N), then
// by how much each uncertain actuator's command differs from what it was told (N, m or Pa).
class LoadedBody {
 public:
  // One uncertainty per cable, then per chamber; actuators with 0 are no load. The response is
  // computed anew where the body stands further than `max_staleness` (m) from where it was.
  LoadedBody(fem::StaticSolver* solver, const std::vector<ForceSite>& sites,
             const std::vector<ActuatorUncertainty>& actuators, double max_staleness);

  int num_components() const { return static_cast<int>(H_f_.cols()); }
  int num_loads() const { return num_components() + static_cast<int>(uncertain_.size()); }
  // Actuator of each load after the components.
  const std::vector<int>& uncertain() const { return uncertain_; }

  // Where it stands, and under which loads.
  struct Pose {
    fem::Equilibrium state;
    Eigen::VectorXd loads;
  };
  const Pose& pose() const { return pose_; }
  const fem::Equilibrium& state() const { return pose_.state; }
  void Return(const Pose& pose) { pose_ = pose; }
  bool HasResponse() const { return response_u_.cols() > 0; }
  // The response is computed anew before it is used again.
  void ForgetResponse() { response_u_.resize(3, 0); }

  // What acts if the actuators were told `told`.
  fem::LoadCase LoadOf(const Eigen::VectorXd& loads, const fem::Actuation& told) const;

  // Whether these loads were the last that it was moved to, and its response is known.
  bool IsAt(const Eigen::VectorXd& loads, const fem::Actuation& told) const;

  // Moves to within `tolerance` (m) of the equilibrium, the response with it; if there is none the
  // pose stays, and the summary says why. `continued`, `max_load_halvings`: see
  // StaticSolver::Approach.
  fem::SolveSummary Move(const Eigen::VectorXd& loads, const fem::Actuation& told, double tolerance,
                         bool continued, std::optional<int> max_load_halvings = std::nullopt);

  // Computes the response anew from the tangent at the pose; false if that is not positive
  // definite.
  bool RenewResponse();

  // The paper's step (eqs. 3, 4 and 6): the response at the pose, then one step of Newton's method.
  bool StepLinearly(const Eigen::VectorXd& loads, const fem::Actuation& told);
  // Moves along the response alone, without looking at the balance.
  void Shift(const Eigen::VectorXd& loads, const fem::Actuation& told);

  // Position of a point of the body now, m, and its derivative by the loads, 3×loads: the best
  // guess for the next step, or that of the tangent as last factorised. The former has learnt from
  // steps in few directions, and says nothing of uncertainty.
  Eigen::Vector3d Position(const mesh::NodalWeights& at) const;
  enum class Of { kStep, kTangent };
  Eigen::Matrix3Xd Response(const mesh::NodalWeights& at, Of of) const;
  // The farthest that any node would move by a change of loads, to first order, m.
  double MoveBy(const Eigen::VectorXd& change) const;

  int factorisations() const { return factorisations_; }  // so far

 private:
  bool IsTold(const fem::Actuation& told) const;
  bool IsResponseFresh() const;
  void LearnFrom(const Pose& before, const Eigen::VectorXd& change, double tolerance);
  bool RefreshResponse();  // unless it is fresh
  bool ComputeResponse(double max_staleness);

  fem::StaticSolver* solver_;
  double max_staleness_;
  std::vector<int> uncertain_;
  Eigen::MatrixXd H_f_;  // 3N×components: nodal force per newton of each
  Pose pose_;
  Eigen::MatrixXd tangent_response_;  // 3N×loads, m per N (m, Pa), of the tangent at response_u_
  Eigen::MatrixXd tension_response_;  // cables×loads, N per the same
  Eigen::MatrixXd response_;          // the former, corrected by the steps made since
  Eigen::Matrix3Xd response_u_;
  Eigen::Array<bool, Eigen::Dynamic, 1> response_taut_;  // which cables were taut there
  int factorisations_ = 0;
};

}  // namespace softforce::estimation
