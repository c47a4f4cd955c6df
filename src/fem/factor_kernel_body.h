// The kernels of factor_kernel.h, for inclusion by one source per instruction set within its
// namespace, under the rules that element_kernel_body.h states. They read the factor once, four
// columns at a time: BLAS's own triangular solves go through it column by column, and take locks.

namespace {

constexpr int kFloats = 8;
constexpr int kColumns = 4;
using Floats = float __attribute__((vector_size(kFloats * sizeof(float))));

Floats LoadFloats(const float* from) {
  Floats value;
  __builtin_memcpy(&value, from, sizeof(value));
  return value;
}

float SumOf(const Floats& value) {
  float sum = 0;
  for (int k = 0; k < kFloats; ++k) sum += value[k];
  return sum;
}

// v[first …] −= Σ_k a[k] · column k, k < n.
template <int n>
void Subtract(const float* const* column, const float* a, int first, int rows, float* v) {
  int r = first;
  for (; r + kFloats <= rows; r += kFloats) {
    Floats sum = LoadFloats(v + r);
    for (int k = 0; k < n; ++k) sum -= a[k] * LoadFloats(column[k] + r);
    __builtin_memcpy(v + r, &sum, sizeof(sum));
  }
  for (; r < rows; ++r) {
    for (int k = 0; k < n; ++k) v[r] -= a[k] * column[k][r];
  }
}

// a[k] = Σ v[r] · column k [r], r from `first`.
template <int n>
void Dot(const float* const* column, const float* v, int first, int rows, float* a) {
  Floats sum[n] = {};
  int r = first;
  for (; r + kFloats <= rows; r += kFloats) {
    const Floats values = LoadFloats(v + r);
    for (int k = 0; k < n; ++k) sum[k] += values * LoadFloats(column[k] + r);
  }
  for (int k = 0; k < n; ++k) {
    a[k] = SumOf(sum[k]);
    for (int tail = r; tail < rows; ++tail) a[k] += v[tail] * column[k][tail];
  }
}

// n columns from `first` on.
template <int n>
void ForwardColumns(const Trapezoid& node, int first, float* v) {
  const float* column[n];
  for (int k = 0; k < n; ++k) column[k] = node.x + static_cast<long>(first + k) * node.stride;
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < k; ++i) v[first + k] -= column[i][first + k] * v[first + i];
    v[first + k] /= column[k][first + k];
  }
  Subtract<n>(column, v + first, first + n, node.rows, v);
}

template <int n>
void BackwardColumns(const Trapezoid& node, int first, float* v) {
  const float* column[n];
  for (int k = 0; k < n; ++k) column[k] = node.x + static_cast<long>(first + k) * node.stride;
  float below[n];
  Dot<n>(column, v, first + n, node.rows, below);
  for (int k = n - 1; k >= 0; --k) {
    float value = v[first + k] - below[k];
    for (int i = k + 1; i < n; ++i) value -= column[k][first + i] * v[first + i];
    v[first + k] = value / column[k][first + k];
  }
}

void Forward(const Trapezoid& node, float* v) {
  int column = 0;
  for (; column + kColumns <= node.columns; column += kColumns) {
    ForwardColumns<kColumns>(node, column, v);
  }
  for (; column < node.columns; ++column) ForwardColumns<1>(node, column, v);
}

void Backward(const Trapezoid& node, float* v) {
  int column = node.columns;
  for (; column % kColumns != 0; --column) BackwardColumns<1>(node, column - 1, v);
  for (; column > 0; column -= kColumns) BackwardColumns<kColumns>(node, column - kColumns, v);
}

}  // namespace

FactorKernels TheFactorKernels() { return {&Forward, &Backward}; }
