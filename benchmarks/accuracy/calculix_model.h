#pragma once

#include <filesystem>

#include "softforce/fem/body.h"

namespace softforce::benchmarks {

// Whether CalculiX has a law for this material when displacements are large.
bool CalculixHasLaw(fem::MaterialModel model);

// Writes what a CalculiX deck needs to know of a body, for *INCLUDE: its nodes (set ALL, in mm),
// 10-node cells, materials (MPa) and the nodes that are held. With `linear`, the materials are
// Hooke's law at the same small-strain moduli. Numbers count from 1.
//
// neo_hookean becomes *HYPERELASTIC, NEO HOOKE: the same deviatoric part, but kappa/2 (J − 1)²
// where softforce has kappa/4 (J² − 1 − 2 ln J). st_venant_kirchhoff becomes *ELASTIC, which with
// NLGEOM is the same law.
//
// Throws InputError naming `where` for 4-node cells or a law that CalculiX does not have.
void WriteCalculixModel(const std::filesystem::path& file, const fem::Body& body, bool linear,
                        const std::string& where);

}  // namespace softforce::benchmarks
