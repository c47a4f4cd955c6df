// Compiled for processors with AVX2 and FMA: see CMakeLists.txt.
#include "fem/element_kernel.h"
#include "fem/factor_kernel.h"

namespace softforce::fem::avx2 {
#include "fem/element_kernel.inc"
#include "fem/factor_kernel.inc"
}  // namespace softforce::fem::avx2
