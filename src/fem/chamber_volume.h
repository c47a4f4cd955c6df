#pragma once

#include <Eigen/Core>
#include <functional>

#include "softforce/fem/body.h"

namespace softforce::fem {

// The volume that a chamber's walls enclose when the nodes stand at `x` (3×N, m): the integral
// −1/3 ∫ x · n dA, n out of the body, exact for flat and for curved walls. With a rim on fixed
// nodes it is right up to a constant, which does no work. Pressure p in the chamber has the energy
// −p · volume, so that its forces and stiffness follow from the derivatives below (m³).
double ChamberVolume(const Chamber& chamber, const Eigen::Matrix3Xd& x);

// Adds scale · ∂volume/∂x to a nodal field (3×N, m²).
void AddChamberVolumeGradient(const Chamber& chamber, const Eigen::Matrix3Xd& x, double scale,
                              Eigen::Matrix3Xd* field);

// Calls add(i, j, scale · ∂²volume/∂x_i∂x_j) with 3×3 blocks (m); blocks of a pair of nodes add up.
void ForEachChamberVolumeCurvature(
    const Chamber& chamber, const Eigen::Matrix3Xd& x, double scale,
    const std::function<void(int, int, const Eigen::Matrix3d&)>& add);

}  // namespace softforce::fem
