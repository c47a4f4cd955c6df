#pragma once

#include "softforce/fem/material.h"

namespace softforce::fem {

// Cells are computed in batches of one law, a cell per lane, so that one instruction works on
// several of them. All arrays have the lane as their last index.
inline constexpr int kLanes = 8;

struct ElementBatch {
  const double* gradients;  // [point][node][xyz][lane], 1/m, of the shape functions
  const double* weights;    // [point][lane], m³; 0 in lanes without a cell
  const double* mu;         // [lane], Pa
  const double* lambda;     // [lane], Pa
  const double* kappa;      // [lane], Pa
  const double* u;          // [node][xyz][lane], m
  double* forces;           // [node][xyz][lane], N; overwritten
};

struct BatchEnergy {
  enum class Status {
    kOk,
    kInvalid,  // the law has no value at some point: a cell is inside out
    kHard      // beyond what the batch can do: compute its cells one by one
  };
  Status status;
  double energy;  // J, sum over the lanes
};

using ElementKernel = BatchEnergy (*)(const ElementBatch&);

// The kernel for cells of 4 nodes (one integration point) or 10 nodes (four points), for the best
// instructions that this processor has.
ElementKernel KernelFor(MaterialModel model, int nodes);

// Kernels by instruction set: the same source compiled with different options.
namespace baseline {
ElementKernel KernelFor(MaterialModel model, int nodes);
}
namespace avx2 {
ElementKernel KernelFor(MaterialModel model, int nodes);
}

}  // namespace softforce::fem
