#include "softforce/fem/compliance.h"

#include <Eigen/QR>

namespace softforce::fem {

double InverseComplianceNorm(const Eigen::MatrixXd& W_ef) {
  return W_ef.completeOrthogonalDecomposition()
      .pseudoInverse()
      .cwiseAbs()
      .colwise()
      .sum()
      .maxCoeff();
}

}  // namespace softforce::fem
