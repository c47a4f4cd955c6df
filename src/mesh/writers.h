#pragma once

#include <filesystem>

#include "softforce/mesh/tet_mesh.h"

// The writers behind WriteMesh, one per kind of file; coordinates are written as they are.
namespace softforce::mesh {

void WriteGmsh(const std::filesystem::path& path, const TetMesh& mesh);  // format 4.1, text

void WriteLegacyVtk(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace softforce::mesh
