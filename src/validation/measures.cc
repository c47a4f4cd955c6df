#include "softforce/validation/measures.h"

#include <Eigen/QR>

namespace softforce::validation {

double ForceError(const Eigen::VectorXd& computed, const Eigen::VectorXd& applied) {
  return (computed - applied).lpNorm<1>();
}

double InverseComplianceNorm(const Eigen::MatrixXd& W_ef) {
  return W_ef.completeOrthogonalDecomposition()
      .pseudoInverse()
      .cwiseAbs()
      .colwise()
      .sum()
      .maxCoeff();
}

}  // namespace softforce::validation
