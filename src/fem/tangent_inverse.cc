#include "fem/tangent_inverse.h"

#include <cmath>
#include <vector>

namespace softforce::fem {
namespace {

constexpr size_t kMostPairs = 12;

double MeanDiagonal(const LowerBlocks& K) {
  double mean = 0;
  for (int column = 0; column < K.size(); ++column) {
    mean += std::abs(K.value[K.column_start[column]]) / K.size();
  }
  return mean;
}

}  // namespace

bool TangentInverse::Factorise(const LowerBlocks& K) {
  pairs_.clear();
  shift_ = 0;
  if (factor_.Factorise(K, 0)) return true;
  const double mean = MeanDiagonal(K);
  for (const double share : {1e-6, 3e-5, 1e-3, 3e-2, 1.0}) {
    shift_ = share * mean;
    if (factor_.Factorise(K, shift_)) return true;
  }
  return false;
}

void TangentInverse::Learn(const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
  const double curvature = step.dot(change);
  // Steps near the rounding of the residual say nothing, and would spoil what is known.
  if (!(curvature > 1e-10 * step.norm() * change.norm())) return;
  if (pairs_.size() == kMostPairs) pairs_.pop_front();
  pairs_.push_back({step, change, curvature});
}

Eigen::VectorXd TangentInverse::Apply(Eigen::VectorXd residual) const {
  std::vector<double> alpha(pairs_.size());
  for (size_t i = pairs_.size(); i-- > 0;) {
    alpha[i] = pairs_[i].step.dot(residual) / pairs_[i].curvature;
    residual -= alpha[i] * pairs_[i].change;
  }
  residual = factor_.SolveRoughly(residual);
  for (size_t i = 0; i < pairs_.size(); ++i) {
    const double beta = pairs_[i].change.dot(residual) / pairs_[i].curvature;
    residual += (alpha[i] - beta) * pairs_[i].step;
  }
  return residual;
}

}  // namespace softforce::fem
