#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fem/cable_path.h"
#include "fem/cholesky.h"
#include "fem/elements.h"
#include "fem/tangent.h"
#include "softforce/fem/static_solver.h"

namespace softforce::fem {

// The largest length of a column, m.
inline double LargestMove(const Eigen::Matrix3Xd& du) {
  return du.cols() == 0 ? 0 : std::sqrt(du.colwise().squaredNorm().maxCoeff());
}

// What a StaticSolver holds: the body prepared for computing, and the tangent as last factorised.
struct StaticSolver::State {
  State(Body body_in, const StaticSolverOptions& options_in)
      : body(std::move(body_in)),
        options(options_in),
        elements(body),
        assembler(body, elements),
        cholesky(assembler.matrix()) {
    diagonal = (body.mesh.nodes.rowwise().maxCoeff() - body.mesh.nodes.rowwise().minCoeff()).norm();
    stiffness = elements.ShearModulusTimesVolume();
    weight = body.density * body.gravity * elements.NodalVolumes(body.mesh.num_nodes()).transpose();
    rest_length.resize(num_cables());
    for (int c = 0; c < num_cables(); ++c) {
      rest_length(c) = CableLength(body.cables[c], body.mesh.nodes);
    }
  }

  int num_cables() const { return static_cast<int>(body.cables.size()); }

  // Nodal vectors of the whole body to those of the free nodes and back, column by column.
  Eigen::MatrixXd Gather(const Eigen::MatrixXd& all) const {
    Eigen::MatrixXd free(3 * assembler.num_free_nodes(), all.cols());
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      const int f = assembler.free_index(node);
      if (f >= 0) free.middleRows<3>(3 * f) = all.middleRows<3>(3 * node);
    }
    for (const int row : assembler.held()) free.row(row).setZero();
    return free;
  }
  Eigen::MatrixXd Scatter(const Eigen::MatrixXd& free) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * body.mesh.num_nodes(), free.cols());
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      const int f = assembler.free_index(node);
      if (f >= 0) all.middleRows<3>(3 * node) = free.middleRows<3>(3 * f);
    }
    return all;
  }

  bool Factorise(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& tension) {
    assembler.Assemble(elements, u, tension);
    factor_u = u;
    factor_valid = cholesky.Factorise(assembler.matrix());
    return factor_valid;
  }

  // Gradients of the cables' lengths as columns, 3N×cables.
  Eigen::MatrixXd CableGradients(const Eigen::Matrix3Xd& u) const {
    Eigen::MatrixXd G(3 * body.mesh.num_nodes(), num_cables());
    for (int c = 0; c < num_cables(); ++c) {
      Eigen::Matrix3Xd gradient = Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes());
      AddCableGradient(body.cables[c], body.mesh.nodes + u, 1, &gradient);
      G.col(c) = gradient.reshaped();
    }
    return G;
  }
  Eigen::VectorXd CableLengths(const Eigen::Matrix3Xd& u) const {
    Eigen::VectorXd length(num_cables());
    for (int c = 0; c < num_cables(); ++c) {
      length(c) = CableLength(body.cables[c], body.mesh.nodes + u);
    }
    return length;
  }

  struct Step {
    Eigen::Matrix3Xd du;
    Eigen::VectorXd tension;  // after the step
    Eigen::VectorXd penalty;  // N/m, that makes the line search's merit fall along du
    Eigen::VectorXd target;   // m, length that each cable is held at; unused for tension
    double slope;             // of the merit along du; < 0
  };
  // What the cells and the dead loads say at a displacement.
  struct Balance {
    double energy = NAN;          // J, potential energy without the cables
    Eigen::Matrix3Xd unbalanced;  // N, internal forces − dead loads, without the cables
  };

  Balance Evaluate(const LoadCase& load, const Eigen::Matrix3Xd& u) const;
  double Merit(const Balance& balance, const Eigen::Matrix3Xd& u, const Step& step) const;
  double SearchAlong(const LoadCase& load, const Equilibrium& at, const Step& step,
                     Balance* balance) const;
  bool MakeStep(const LoadCase& load, const Equilibrium& at, const Eigen::Matrix3Xd& unbalanced,
                Step* step) const;
  bool Newton(const LoadCase& load, Equilibrium* state, SolveSummary* summary);

  Body body;
  StaticSolverOptions options;
  Elements elements;
  TangentAssembler assembler;
  Cholesky cholesky;
  double diagonal = NAN;   // m
  double stiffness = NAN;  // J, shear modulus times volume: the scale of rounding in the energy
  Eigen::Matrix3Xd weight;
  Eigen::VectorXd rest_length;
  Eigen::Matrix3Xd factor_u;  // where the tangent was factorised
  bool factor_valid = false;
};

}  // namespace softforce::fem
