#pragma once

#include <cholmod.h>

#include <Eigen/Core>
#include <vector>

#include "fem/factor_kernel.h"

namespace softforce::fem {

// A supernodal factor L of P A Pᵀ = L Lᵀ, rounded to single precision. A solve with one right-hand
// side does little else than read L from memory, so that half the bytes take half the time, or less
// where L then fits into the cache. Good for corrections that are corrected again.
class SingleFactor {
 public:
  // Copies the numbers of L. The pattern is referred to: `factor` must live as long.
  void Take(const cholmod_factor& factor);

  // A⁻¹ b, with the relative error that single precision leaves on a matrix of that condition.
  Eigen::VectorXd Solve(const Eigen::VectorXd& b) const;

 private:
  const FactorKernels kernels_ = BestFactorKernels();
  const cholmod_factor* pattern_ = nullptr;
  std::vector<float> x_;
  mutable Eigen::VectorXf work_, rows_;
};

}  // namespace softforce::fem
