#pragma once

#include <vector>

#include "softforce/validation/study.h"

namespace softforce::validation {

inline constexpr double kTolerance = 1e-9;  // of the body's diagonal, of direct and inverse models
inline constexpr double kFinest = 1e-8;     // m, of the estimates

using Points = std::vector<Eigen::Vector3d>;  // m

// What a layout's markers show of the direct model.
struct Views {
  Points unloaded, weighed, loaded;
};

// The same, seen by a frame that is off along z (m).
Points Shifted(Points points, double z);

// The body's materials with another Young's modulus (Pa).
std::vector<fem::Material> OfModulus(const Model& model, double youngs_modulus);

// The remedies, on the finer mesh: what is wrong is identified with a known weight, the place of
// the measuring frame is found along with the forces, and the robot's markers are compared with the
// model before the forces come, under its cables. Sets what `result` says of them.
void RunRemedied(const Model& finer, const Views& views, InexactCase* result);

}  // namespace softforce::validation
