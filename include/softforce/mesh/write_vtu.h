#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/mesh/surface.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// A vector at every node, for ParaView's "Warp By Vector" and glyphs, or a number.
struct PointField {
  std::string name;        // with its unit: "displacement_m"
  Eigen::MatrixXd values;  // 3×N or 1×N
};

// A number of every cell, for colours; NaN where there is none.
struct CellField {
  std::string name;
  Eigen::VectorXd values;  // E
};

// Writes a VTU file with the mesh in metres (4- or 10-node cells), the fields, and, unless the mesh
// is one unnamed region, the cell array "region": a region named by an integer has that value,
// others have 1 + their index. Surface groups are not written. The same mesh gives the same bytes.
// Throws InputError if the file cannot be written.
void WriteVtu(const std::filesystem::path& path, const TetMesh& mesh,
              const std::vector<PointField>& fields = {},
              const std::vector<CellField>& cell_fields = {});

// The same of the surface alone, with a number for each triangle (nodes at x, 3×N, m).
void WriteSurfaceVtu(const std::filesystem::path& path, const Surface& surface,
                     const Eigen::Matrix3Xd& x, const std::vector<CellField>& fields);

// Points by themselves (3×N, m; there may be none), for glyphs, and their fields.
void WritePointsVtu(const std::filesystem::path& path, const Eigen::Matrix3Xd& places,
                    const std::vector<PointField>& fields);

}  // namespace softforce::mesh
