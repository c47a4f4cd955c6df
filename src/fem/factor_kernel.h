#pragma once

namespace softforce::fem {

// A supernode of a triangular factor: columns of one pattern, stored one after the other with
// `stride` numbers each, the first `columns` rows of which are their own triangle.
struct Trapezoid {
  const float* x;
  int columns;
  int rows;
  int stride;
};

// Both work on v, `rows` numbers: first those of the supernode's own columns, then those below.
struct FactorKernels {
  // Solves with the triangle, and takes what that solution causes below from the rest of v.
  void (*forward)(const Trapezoid&, float* v);
  // Takes what the rows below cause from the own ones, and solves with the transposed triangle.
  void (*backward)(const Trapezoid&, float* v);
};

// For the best instructions that this processor has.
FactorKernels BestFactorKernels();

// By instruction set: the same source compiled with different options.
namespace baseline {
FactorKernels TheFactorKernels();
}
namespace avx2 {
FactorKernels TheFactorKernels();
}

}  // namespace softforce::fem
