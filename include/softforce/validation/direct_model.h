#pragma once

#include <vector>

#include "softforce/validation/model.h"

namespace softforce::validation {

// Forces at places of the body, as a load.
fem::LoadCase LoadOf(const Model& model, const std::vector<AppliedForce>& forces,
                     const fem::Actuation& actuation);

// Where the places of the surface at rest are in an equilibrium, m.
std::vector<Eigen::Vector3d> Seen(const Model& model, const fem::Equilibrium& state,
                                  const std::vector<Eigen::Vector3d>& places);

// A direct model: the body that the inverse models watch, its cables (if any) at kTension.
struct DirectModel {
  Model model;
  fem::Equilibrium unloaded;
  fem::Equilibrium weighed;              // with KnownWeight
  std::vector<fem::Equilibrium> loaded;  // with growing shares of AppliedForces; last: with all
};

// Solves it to `tolerance` (share of the body's diagonal), the loads in `frames` equal steps.
// Throws InputError if it finds no equilibrium.
DirectModel SolveDirectModel(BodyKind kind, Model model, int frames, double tolerance);

}  // namespace softforce::validation
