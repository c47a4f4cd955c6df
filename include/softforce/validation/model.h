#pragma once

#include <filesystem>
#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"
#include "softforce/validation/layout.h"

namespace softforce::validation {

// What the direct models are made of.
inline constexpr double kYoungsModulus = 300e3;  // Pa
inline constexpr double kPoissonsRatio = 0.45;
inline constexpr double kTension = 2;   // N, of each of the robot's cables
inline constexpr double kPatch = 6e-3;  // m, diameter of the discs on which forces act

// A body of the study, and its surface to find places on.
struct Model {
  fem::Body body;
  mesh::Surface surface;
};

// The body's mesh with 4-node cells. Throws InputError if the folder does not hold it.
mesh::TetMesh ReadBodyMesh(BodyKind body, const std::filesystem::path& meshes);

// The sheet is clamped at its corners, the robot stands on its feet and has two cables.
Model MakeModel(BodyKind kind, mesh::TetMesh mesh, double youngs_modulus);

// Each cable at so many newtons more than kTension.
fem::Actuation Tensioned(const fem::Body& body, double excess = 0);

// The point of the body's surface closest to a place, as shape functions.
mesh::NodalWeights PointAt(const Model& model, const Eigen::Vector3d& place);

// A free force spread over a disc at the place.
estimation::ForceSite SiteAt(const Model& model, const Eigen::Vector3d& place);

}  // namespace softforce::validation
