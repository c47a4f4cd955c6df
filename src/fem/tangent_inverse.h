#pragma once

#include <Eigen/Core>
#include <deque>

#include "fem/cholesky.h"
#include "fem/tangent.h"

namespace softforce::fem {

// Stands for K⁻¹ near the place where the tangent K was last factorised: that factor, corrected by
// what the steps taken since have shown of K (limited-memory BFGS with the factor as its start;
// Nocedal & Wright, Numerical Optimization, 2nd ed., algorithm 7.4). Symmetric and positive
// definite. A body of hundreds of small steps under few loads is so followed with few
// factorisations: the corrections cover just the directions in which it moves.
class TangentInverse {
 public:
  explicit TangentInverse(const LowerBlocks& pattern) : factor_(pattern) {}

  // Factorises K and forgets the corrections. A K that is not positive definite is made so by
  // adding a multiple of the identity, see `shift`. False if that fails too.
  bool Factorise(const LowerBlocks& K);

  // What was added to K's diagonal to factorise it, N/m; 0 for a stable body.
  double shift() const { return shift_; }

  // Takes note that the displacement `step` (m) changed the residual by `change` (N), both on the
  // free degrees of freedom.
  void Learn(const Eigen::VectorXd& step, const Eigen::VectorXd& change);

  Eigen::VectorXd Apply(Eigen::VectorXd residual) const;

  // The factor alone, for many right-hand sides at once: replaces the columns of `b`.
  void ApplyFactor(Eigen::MatrixXd* b) const { factor_.SolveInPlace(b); }

 private:
  struct Pair {
    Eigen::VectorXd step, change;
    double curvature;  // step · change, J; > 0
  };

  Cholesky factor_;
  double shift_ = 0;
  std::deque<Pair> pairs_;  // oldest first
};

}  // namespace softforce::fem
