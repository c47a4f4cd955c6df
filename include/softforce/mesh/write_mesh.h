#pragma once

#include <filesystem>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// Writes a mesh with coordinates in units of `metres_per_unit`, the reverse of ReadMesh:
// - .msh (Gmsh format 4.1, text) keeps everything: regions as physical volumes, surface groups as
//   physical surfaces. A triangle of several groups is written once, which may change the order of
//   the triangles in a group.
// - .vtu and .vtk keep the cells and the regions, numbered as WriteVtu does, but no surface groups.
// The file appears under its name only once it is complete; the same mesh gives the same bytes.
// Throws InputError if the extension is another, the file cannot be written, or a surface group
// names nodes that are not the corners of a face of the mesh.
void WriteMesh(const std::filesystem::path& path, const TetMesh& mesh, double metres_per_unit);

// Throws InputError unless the extension is one that WriteMesh knows.
void CheckCanWriteMesh(const std::filesystem::path& path);

// Whether WriteMesh keeps surface groups and names of regions in such a file.
bool KeepsNames(const std::filesystem::path& path);

}  // namespace softforce::mesh
