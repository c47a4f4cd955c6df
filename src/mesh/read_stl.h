#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

namespace softforce::mesh {

// Closed surfaces of triangles, in the file's unit. Where a file repeats a corner in several
// triangles, it is one node.
struct StlSurface {
  Eigen::Matrix3Xd nodes;
  std::vector<std::array<int, 3>> triangles;  // of one shell all turn the same way
  std::vector<int> shell;                     // of each triangle
  std::vector<double> shell_volumes;          // enclosed, > 0
  std::vector<int> depth;   // of each shell: within how many others it lies; if odd, a cavity
  std::vector<int> parent;  // of each shell: the innermost one around it, or -1

  int num_shells() const { return static_cast<int>(shell_volumes.size()); }
};

// Reads a text or binary .stl. Throws InputError if it is damaged, empty, or not closed, or if
// surfaces touch along edges.
StlSurface ReadStl(const std::filesystem::path& path);

}  // namespace softforce::mesh
