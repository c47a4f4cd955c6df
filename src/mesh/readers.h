#pragma once

#include <filesystem>

#include "softforce/mesh/tet_mesh.h"

// The readers behind ReadMesh, one per kind of file; lengths stay in the file's unit.
namespace softforce::mesh {

TetMesh ReadGmsh(const std::filesystem::path& path);

TetMesh ReadVtk(const std::filesystem::path& path);  // legacy .vtk
TetMesh ReadVtu(const std::filesystem::path& path);

}  // namespace softforce::mesh
