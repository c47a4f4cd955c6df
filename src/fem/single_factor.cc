#include "fem/single_factor.h"

#include <algorithm>

namespace softforce::fem {
namespace {

struct Supernode {
  Trapezoid entries;
  int first;        // column of L
  const int* rows;  // of L, all of its rows
};

Supernode At(const cholmod_factor& factor, const std::vector<float>& x, size_t s) {
  const int* super = static_cast<const int*>(factor.super);
  const int* pi = static_cast<const int*>(factor.pi);
  const int* px = static_cast<const int*>(factor.px);
  const int rows = pi[s + 1] - pi[s];
  return {{x.data() + px[s], super[s + 1] - super[s], rows, rows},
          super[s],
          static_cast<const int*>(factor.s) + pi[s]};
}

}  // namespace

void SingleFactor::Take(const cholmod_factor& factor) {
  pattern_ = &factor;
  const double* x = static_cast<const double*>(factor.x);
  x_.resize(factor.xsize);
  std::transform(x, x + factor.xsize, x_.begin(), [](double v) { return static_cast<float>(v); });
  work_.resize(static_cast<Eigen::Index>(factor.n));
  int most = 0;
  for (size_t s = 0; s < factor.nsuper; ++s) most = std::max(most, At(factor, x_, s).entries.rows);
  rows_.resize(most);
}

Eigen::VectorXd SingleFactor::Solve(const Eigen::VectorXd& b) const {
  const int* permutation = static_cast<const int*>(pattern_->Perm);
  const double scale = b.cwiseAbs().maxCoeff();  // keeps single precision in its range
  if (!(scale > 0)) return b;
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    work_(i) = static_cast<float>(b(permutation[i]) / scale);
  }
  float* v = rows_.data();
  for (size_t s = 0; s < pattern_->nsuper; ++s) {
    const Supernode node = At(*pattern_, x_, s);
    const int own = node.entries.columns, all = node.entries.rows;
    std::copy_n(work_.data() + node.first, own, v);
    std::fill(v + own, v + all, 0.0F);
    kernels_.forward(node.entries, v);
    std::copy_n(v, own, work_.data() + node.first);
    for (int r = own; r < all; ++r) work_(node.rows[r]) += v[r];
  }
  for (size_t s = pattern_->nsuper; s-- > 0;) {
    const Supernode node = At(*pattern_, x_, s);
    for (int r = 0; r < node.entries.rows; ++r) v[r] = work_(node.rows[r]);
    kernels_.backward(node.entries, v);
    std::copy_n(v, node.entries.columns, work_.data() + node.first);
  }
  Eigen::VectorXd solution(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) solution(permutation[i]) = scale * work_(i);
  return solution;
}

}  // namespace softforce::fem
