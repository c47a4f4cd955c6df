#pragma once

#include <string>

#include "softforce/mesh/generate_mesh.h"

namespace softforce::mesh {

// ".step" also for "BODY.STEP": CAD programs write either.
std::string LowerExtension(const std::filesystem::path& path);

// The ways behind GenerateMesh to put a solid into Gmsh's current model. Each returns the solid's
// volume in the file's unit cubed, NaN if it is not known.

// `size` in the file's unit; NaN keeps the file's triangles.
double LoadStl(const std::filesystem::path& path, double size, double feature_angle);

double LoadCad(const std::filesystem::path& path);  // .step, .stp, .brep

double LoadGeoScript(const std::filesystem::path& path);

}  // namespace softforce::mesh
