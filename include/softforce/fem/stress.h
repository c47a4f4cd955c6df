#pragma once

#include <Eigen/Core>

#include "softforce/fem/body.h"

namespace softforce::fem {

using Vector6d = Eigen::Matrix<double, 6, 1>;

// sqrt(3/2 s : s) with s the deviator of a stress xx yy zz xy yz zx, in its unit.
double VonMises(const Vector6d& stress);

// Cauchy stress σ = P Fᵀ / J at the nodes, 6×N, Pa, rows xx yy zz xy yz zx, with the nodes moved by
// `u` (3×N, m). The laws are evaluated at the integration points, where the cells are most
// accurate, carried on linearly to the nodes, and averaged over the cells around each node by their
// volume; across a boundary between two materials, where stress jumps, that is a mean of both. NaN
// around a cell that is inside out.
Eigen::Matrix<double, 6, Eigen::Dynamic> NodalStress(const Body& body, const Eigen::Matrix3Xd& u);

// The von Mises stress of that, N, Pa.
Eigen::VectorXd NodalVonMises(const Body& body, const Eigen::Matrix3Xd& u);

}  // namespace softforce::fem
