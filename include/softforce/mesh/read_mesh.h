#pragma once

#include <filesystem>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// Reads tetrahedra from a Gmsh file (.msh, formats 2.2 and 4.1, ASCII or binary), a legacy VTK file
// (.vtk) or a VTU file (.vtu) with 4- or 10-node cells. Coordinates are multiplied by
// `metres_per_unit`. Physical volumes become regions, physical surfaces become surface groups
// (Gmsh; a group without a name is called by its number). In VTK files an integer cell array
// "region" of the tetrahedra gives the regions, named "1", "2", … after its values. Elements that
// are not tetrahedra or named surface triangles are left out. The mesh is as it stands in the file,
// unchecked: see CheckMesh. Throws InputError if the file is missing, of another kind, damaged, or
// holds no tetrahedron. Not for two threads at once: Gmsh and VTK keep global state.
TetMesh ReadMesh(const std::filesystem::path& path, double metres_per_unit);

}  // namespace softforce::mesh
