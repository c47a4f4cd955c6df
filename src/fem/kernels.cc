// Which of the kernels, compiled for different instruction sets, this processor can run.
#include "fem/element_kernel.h"
#include "fem/factor_kernel.h"

namespace softforce::fem {
namespace {

bool HasAvx2() {
#ifdef SOFTFORCE_WITH_AVX2
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

}  // namespace

ElementKernel KernelFor(MaterialModel model, int nodes) {
  return HasAvx2() ? avx2::KernelFor(model, nodes) : baseline::KernelFor(model, nodes);
}

FactorKernels BestFactorKernels() {
  return HasAvx2() ? avx2::TheFactorKernels() : baseline::TheFactorKernels();
}

}  // namespace softforce::fem
