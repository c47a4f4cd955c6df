#include "fem/element_kernel.h"
#include "fem/factor_kernel.h"

namespace softforce::fem::baseline {
#include "fem/element_kernel.inc"
#include "fem/factor_kernel.inc"
}  // namespace softforce::fem::baseline
