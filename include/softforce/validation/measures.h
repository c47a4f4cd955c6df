#pragma once

#include <Eigen/Core>

namespace softforce::validation {

// The paper's I_e = ‖f_computed − f_applied‖₁ (VI.A): the sum over all components of all
// candidates, in the unit of the forces. NaN if the computed force is.
double ForceError(const Eigen::VectorXd& computed, const Eigen::VectorXd& applied);

}  // namespace softforce::validation
