#include "fem/element_kernel.h"
#include "fem/factor_kernel.h"

namespace softforce::fem::baseline {
#include "fem/element_kernel_body.h"
#include "fem/factor_kernel_body.h"
}  // namespace softforce::fem::baseline
