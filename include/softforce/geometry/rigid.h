#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace softforce::geometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The matrix with Skew(a) * b = a × b.
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

// The rigid transform of a twist xi = (translation rho [m], rotation phi [rad]) by the exponential
// map.
Eigen::Isometry3d ExpSe3(const Vector6d& xi);

// How far `R` is from a rotation: the largest entry of |RᵀR − I|, or 2 if it mirrors.
double RotationDefect(const Eigen::Matrix3d& R);

}  // namespace softforce::geometry
