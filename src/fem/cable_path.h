#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "softforce/fem/body.h"

namespace softforce::fem {

// The nodes that a cable pulls on, each once, ascending.
std::vector<int> CableNodes(const Cable& cable);

// Length of the cable from its attachment through its via points to the guide, m; x: nodes, 3×N, m.
double CableLength(const Cable& cable, const Eigen::Matrix3Xd& x);

// Adds scale · ∂length/∂x to `field` (3×N). The gradient has no unit; tension times it is the force
// that resists the cable's getting longer.
void AddCableGradient(const Cable& cable, const Eigen::Matrix3Xd& x, double scale,
                      Eigen::Matrix3Xd* field);

// Calls `add(i, j, K_ij)` for the 3×3 blocks of tension · ∂²length/∂x², N/m, for every ordered pair
// of nodes; a pair may come up more than once, and the blocks add up.
void ForEachCableStiffness(const Cable& cable, const Eigen::Matrix3Xd& x, double tension,
                           const std::function<void(int, int, const Eigen::Matrix3d&)>& add);

}  // namespace softforce::fem
