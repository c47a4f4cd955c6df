#include "fem/single_factor.h"

#include <cblas.h>

#include <algorithm>

namespace softforce::fem {
namespace {

// Columns of L that share one pattern of rows: a dense trapezoid.
struct Supernode {
  int first, columns;    // of L
  int rows_below;        // the rows after those of the columns themselves,
  const int* row_below;  // by number
  const float* x;        // column by column, all rows
  int stride;

  const float* below() const { return x + columns; }
};

Supernode At(const cholmod_factor& factor, const std::vector<float>& x, size_t s) {
  const int* super = static_cast<const int*>(factor.super);
  const int* pi = static_cast<const int*>(factor.pi);
  const int* px = static_cast<const int*>(factor.px);
  const int columns = super[s + 1] - super[s];
  const int rows = pi[s + 1] - pi[s];
  return {super[s],         columns,
          rows - columns,   static_cast<const int*>(factor.s) + pi[s] + columns,
          x.data() + px[s], rows};
}

}  // namespace

void SingleFactor::Take(const cholmod_factor& factor) {
  pattern_ = &factor;
  const double* x = static_cast<const double*>(factor.x);
  x_.resize(factor.xsize);
  std::transform(x, x + factor.xsize, x_.begin(), [](double v) { return static_cast<float>(v); });
  work_.resize(static_cast<Eigen::Index>(factor.n));
  rows_.resize(static_cast<Eigen::Index>(factor.maxesize));
}

Eigen::VectorXd SingleFactor::Solve(const Eigen::VectorXd& b) const {
  const int* permutation = static_cast<const int*>(pattern_->Perm);
  const double scale = b.cwiseAbs().maxCoeff();  // keeps single precision in its range
  if (!(scale > 0)) return b;
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    work_(i) = static_cast<float>(b(permutation[i]) / scale);
  }
  for (size_t s = 0; s < pattern_->nsuper; ++s) {
    const Supernode node = At(*pattern_, x_, s);
    float* own = work_.data() + node.first;
    cblas_strsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, node.columns, node.x,
                node.stride, own, 1);
    if (node.rows_below == 0) continue;
    cblas_sgemv(CblasColMajor, CblasNoTrans, node.rows_below, node.columns, 1, node.below(),
                node.stride, own, 1, 0, rows_.data(), 1);
    for (int r = 0; r < node.rows_below; ++r) work_(node.row_below[r]) -= rows_(r);
  }
  for (size_t s = pattern_->nsuper; s-- > 0;) {
    const Supernode node = At(*pattern_, x_, s);
    float* own = work_.data() + node.first;
    if (node.rows_below > 0) {
      for (int r = 0; r < node.rows_below; ++r) rows_(r) = work_(node.row_below[r]);
      cblas_sgemv(CblasColMajor, CblasTrans, node.rows_below, node.columns, -1, node.below(),
                  node.stride, rows_.data(), 1, 1, own, 1);
    }
    cblas_strsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, node.columns, node.x,
                node.stride, own, 1);
  }
  Eigen::VectorXd solution(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) solution(permutation[i]) = scale * work_(i);
  return solution;
}

}  // namespace softforce::fem
