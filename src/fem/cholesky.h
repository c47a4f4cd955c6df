#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem/tangent.h"

namespace softforce::fem {

// Supernodal Cholesky factorisation of symmetric positive definite matrices of one pattern, by
// CHOLMOD. The pattern is analysed once (the better of AMD and METIS). Runs on one thread whatever
// the environment says: Debian's CHOLMOD 5.12 asks OpenMP for four threads by itself, which on
// matrices of this size costs a factor of three to six.
class Cholesky {
 public:
  explicit Cholesky(const LowerBlocks& pattern);
  ~Cholesky();

  // False if the matrix is not positive definite; the factor is then unusable.
  bool Factorise(const LowerBlocks& matrix);

  // Replaces the columns of `b` by the solutions.
  void SolveInPlace(Eigen::MatrixXd* b) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::fem
