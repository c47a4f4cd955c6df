#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fem/cable_path.h"
#include "fem/elements.h"
#include "fem/tangent.h"
#include "fem/tangent_inverse.h"
#include "softforce/fem/static_solver.h"

namespace softforce::fem {

// The largest length of a column, m.
inline double LargestMove(const Eigen::Matrix3Xd& du) {
  return du.cols() == 0 ? 0 : std::sqrt(du.colwise().squaredNorm().maxCoeff());
}

// What a StaticSolver holds: the body prepared for computing, and the tangent as last factorised.
struct StaticSolver::State {
  State(Body body_in, const StaticSolverOptions& options_in);

  void SetMaterials(std::vector<Material> materials);

  int num_cables() const { return static_cast<int>(body.cables.size()); }

  // Nodal vectors of the whole body to those of the free nodes and back, column by column. Held
  // components become zero.
  Eigen::MatrixXd Gather(const Eigen::MatrixXd& all) const;
  Eigen::MatrixXd Scatter(const Eigen::MatrixXd& free) const;

  // Gradients of the cables' lengths as columns, 3N×cables.
  Eigen::MatrixXd CableGradients(const Eigen::Matrix3Xd& u) const;
  Eigen::VectorXd CableLengths(const Eigen::Matrix3Xd& u) const;

  // Factorises the tangent; false if it cannot be made positive definite. `StableAt` is stricter:
  // whether it is so by itself at an equilibrium.
  bool Factorise(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& tension,
                 const std::vector<double>& pressures);
  bool StableAt(const Equilibrium& state);

  // What the cells say at a displacement: J, and N on the nodes.
  struct Elastic {
    Eigen::Matrix3Xd u;
    double energy = NAN;
    Eigen::Matrix3Xd forces;
  };
  // Potential energy without the cables, and its gradient: internal forces less dead loads,
  // gravity and pressures.
  struct Balance {
    double energy = NAN;          // J
    Eigen::Matrix3Xd unbalanced;  // N
  };
  Balance Evaluate(const LoadCase& load, const Eigen::Matrix3Xd& u);

  struct Step {
    Eigen::Matrix3Xd du;
    Eigen::VectorXd tension;        // after the step
    Eigen::VectorXd penalty;        // N/m, that makes the line search's merit fall along du
    Eigen::VectorXd target;         // m, length that each cable is held at; unused for tension
    Eigen::VectorXd free_du;        // du and the residual under the new tension, on the free
    Eigen::VectorXd free_residual;  // degrees of freedom
    double slope = NAN;             // of the merit along du; < 0
  };
  bool MakeStep(const LoadCase& load, const Equilibrium& at, const Eigen::Matrix3Xd& unbalanced,
                Step* step) const;
  std::vector<int> CablesToHold(const LoadCase& load, const Equilibrium& at,
                                const Eigen::VectorXd& length, Step* step) const;
  double Merit(const Balance& balance, const Eigen::Matrix3Xd& u, const Step& step) const;
  double SearchAlong(const LoadCase& load, const Equilibrium& at, const Step& step,
                     Balance* balance);

  bool SlackCablesFit(const LoadCase& load, const Equilibrium& state, double tolerance) const;
  SolveSummary::Status StalledStatus() const;
  // Moves `state` to within `tolerance` (m) of the equilibrium under `load`; why not, if it cannot.
  SolveSummary::Status Newton(const LoadCase& load, double tolerance, Equilibrium* state,
                              SolveSummary* summary);

  Body body;
  StaticSolverOptions options;
  Elements elements;
  TangentAssembler assembler;
  TangentInverse inverse;
  double diagonal = NAN;   // m
  double stiffness = NAN;  // J, shear modulus times volume: the scale of rounding in the energy
  Eigen::Matrix3Xd weight;
  Eigen::VectorXd rest_length;

  Elastic elastic;                // as last evaluated
  Eigen::Matrix3Xd factor_u;      // where the tangent was factorised
  Eigen::MatrixXd cable_columns;  // K⁻¹ · cable gradients there, on the free degrees of freedom
  bool factor_valid = false;
  int steps_to_load = 0;  // iterations since the load was changed by more than a correction
  double wasted = 0;      // iterations that a fresh factor would have saved since
};

}  // namespace softforce::fem
