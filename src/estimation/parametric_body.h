#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "softforce/estimation/identification.h"

namespace softforce::estimation {

// A body in several known states at once, as a function of its unknown numbers θ: changes from the
// start, in the units of Identification::change.
class ParametricBody {
 public:
  // The states must outlive it. Throws InputError for a body or states of no use.
  ParametricBody(fem::Body body, const std::vector<KnownState>& states,
                 const std::vector<Unknown>& unknowns, const IdentificationOptions& options);

  int num_unknowns() const { return static_cast<int>(unknowns_.size()); }

  // Brings every state to equilibrium, and computes ∂u/∂θ there while its tangent is at hand. False
  // if one has none, if a tangent is not positive definite, or if θ is further away from where the
  // body stood before than an iteration may go.
  bool MoveTo(const Eigen::VectorXd& theta);

  Eigen::Vector3d Position(int state, const mesh::NodalWeights& at) const;      // m
  Eigen::Vector3d Displacement(int state, const mesh::NodalWeights& at) const;  // m
  Eigen::Matrix3Xd Jacobian(int state, const mesh::NodalWeights& at) const;     // 3×unknowns

  std::vector<fem::Material> Materials(const Eigen::VectorXd& theta) const;  // per region
  Eigen::VectorXd CableOffsets(const Eigen::VectorXd& theta) const;          // per cable, m or N

  // Limits of θ, from the range of Poisson's ratio; infinite for other unknowns.
  double Lower(int unknown) const;
  double Upper(int unknown) const;

  int factorisations() const { return factorisations_; }

 private:
  std::vector<int> RegionsOf(const Unknown& unknown) const;
  bool Solve(int state, const Eigen::VectorXd& theta, fem::Equilibrium* equilibrium);
  // ∂u/∂θ at an equilibrium, 3N×unknowns; nothing if its tangent is not positive definite.
  std::optional<Eigen::MatrixXd> Sensitivities(const fem::Equilibrium& at);
  // ∂f_int/∂θ of a material's unknown, 3N, N.
  Eigen::VectorXd ForceDerivative(const Eigen::Matrix3Xd& u, const Unknown& unknown) const;

  const std::vector<KnownState>& states_;
  std::vector<Unknown> unknowns_;
  IdentificationOptions options_;
  std::vector<fem::Material> start_materials_;
  fem::StaticSolver solver_;
  Eigen::VectorXd theta_;              // of now_ and du_; not finite before the first
  std::vector<fem::Equilibrium> now_;  // per state
  std::vector<Eigen::MatrixXd> du_;    // per state, 3N×unknowns
  int factorisations_ = 0;
};

}  // namespace softforce::estimation
