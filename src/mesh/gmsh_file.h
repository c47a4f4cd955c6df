#pragma once

#include <cstddef>
#include <filesystem>

namespace softforce::mesh {

// What a Gmsh file announces.
struct GmshFileCounts {
  std::size_t nodes = 0;
  std::size_t elements = 0;  // of any dimension
};

// Makes sure that a file is a whole Gmsh mesh before the SDK sees it, because the SDK takes what is
// not a mesh for a script and runs it, and crashes on some damaged files. Throws InputError if the
// file is not format 2 or 4.1, a section is not closed, counts are impossible, or text holds a
// token that does not belong there.
GmshFileCounts InspectGmshFile(const std::filesystem::path& path);

}  // namespace softforce::mesh
