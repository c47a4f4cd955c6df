#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::mesh {

// A surface at rest, with what selectors ask about.
struct SelectableSurface {
  explicit SelectableSurface(const TetMesh& mesh);

  Surface surface;
  Eigen::Matrix3Xd x;        // nodes, 3×N, m
  Eigen::Matrix3Xd normals;  // of the triangles, 3×T
  std::vector<int> part;     // of each triangle, see SurfaceParts
  std::vector<char> part_is_cavity;
  Eigen::Vector3d low, high;  // the body's bounding box, m
  double tolerance;           // m: places closer than this are the same
};

// Whether each triangle is selected by a selector as WithSurfaceGroups describes it. Throws
// InputError naming `where` if it cannot be read.
std::vector<char> Select(const SelectableSurface& body, const std::string& selector,
                         const std::string& where);

}  // namespace softforce::mesh
