#include "fem/cholesky.h"

#include <cblas.h>
#include <cholmod.h>
#include <omp.h>

#include <cassert>
#include <cstring>

#include "fem/single_factor.h"

namespace softforce::fem {
namespace {

// While it lives, OpenMP regions entered by this thread run on this thread alone (a level limit of
// 0 outranks the num_threads clauses inside CHOLMOD). OpenBLAS is held to one thread for good.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) {
    omp_set_max_active_levels(0);
    openblas_set_num_threads(1);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

}  // namespace

struct Cholesky::State {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  SingleFactor rounded;
  cholmod_dense *solution = nullptr, *work_y = nullptr,
                *work_e = nullptr;  // kept from solve to solve

  State() {
    cholmod_start(&common);
    common.print = 0;  // "not positive definite" is an answer here, not a message
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.nmethods = 2;
    common.method[0].ordering = CHOLMOD_AMD;
    common.method[1].ordering = CHOLMOD_METIS;
  }
  ~State() {
    cholmod_free_factor(&factor, &common);
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

namespace {

// CHOLMOD's view of the matrix; nothing is copied, and CHOLMOD does not write to it.
cholmod_sparse View(const LowerBlocks& matrix) {
  cholmod_sparse view;
  std::memset(&view, 0, sizeof(view));
  view.nrow = view.ncol = matrix.size();
  view.nzmax = matrix.row.size();
  view.p = const_cast<int*>(matrix.column_start.data());
  view.i = const_cast<int*>(matrix.row.data());
  view.x = const_cast<double*>(matrix.value.data());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace

Cholesky::Cholesky(const LowerBlocks& pattern) : state_(std::make_unique<State>()) {
  const OneThread guard;
  cholmod_sparse view = View(pattern);
  state_->factor = cholmod_analyze(&view, &state_->common);
  assert(state_->factor != nullptr);
}

Cholesky::~Cholesky() = default;

bool Cholesky::Factorise(const LowerBlocks& matrix, double shift) {
  const OneThread guard;
  cholmod_sparse view = View(matrix);
  double beta[2] = {shift, 0};
  cholmod_factorize_p(&view, beta, nullptr, 0, state_->factor, &state_->common);
  if (state_->common.status != CHOLMOD_OK) return false;
  state_->rounded.Take(*state_->factor);
  return true;
}

Eigen::VectorXd Cholesky::SolveRoughly(const Eigen::VectorXd& b) const {
  const OneThread guard;
  return state_->rounded.Solve(b);
}

void Cholesky::SolveInPlace(Eigen::MatrixXd* b) const {
  const OneThread guard;
  cholmod_dense rhs;
  std::memset(&rhs, 0, sizeof(rhs));
  rhs.nrow = b->rows();
  rhs.d = b->rows();
  rhs.ncol = b->cols();
  rhs.nzmax = rhs.d * rhs.ncol;
  rhs.x = b->data();
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  State& s = *state_;
  cholmod_solve2(CHOLMOD_A, s.factor, &rhs, nullptr, &s.solution, nullptr, &s.work_y, &s.work_e,
                 &s.common);
  assert(s.common.status == CHOLMOD_OK);
  *b = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(s.solution->x), b->rows(),
                                         b->cols());
}

}  // namespace softforce::fem
