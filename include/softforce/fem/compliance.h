#pragma once

#include <Eigen/Core>

namespace softforce::fem {

// The paper's I_w = ‖W_ef⁺‖₁ (VI.A), N/m: the largest sum of absolute values in a column of the
// pseudo-inverse of the compliance (m/N). A coordinate of a marker that is wrong by d makes the
// components of all forces wrong by I_w·d together, at most. The paper prints mm/N, but its figures
// are those of N/mm.
double InverseComplianceNorm(const Eigen::MatrixXd& W_ef);

}  // namespace softforce::fem
