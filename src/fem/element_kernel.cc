#include "fem/element_kernel.h"

namespace softforce::fem {

ElementKernel KernelFor(MaterialModel model, int nodes) {
#ifdef SOFTFORCE_WITH_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return avx2::KernelFor(model, nodes);
  }
#endif
  return baseline::KernelFor(model, nodes);
}

}  // namespace softforce::fem
