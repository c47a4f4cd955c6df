#include "softforce/validation/measures.h"

namespace softforce::validation {

double ForceError(const Eigen::VectorXd& computed, const Eigen::VectorXd& applied) {
  return (computed - applied).lpNorm<1>();
}

}  // namespace softforce::validation
