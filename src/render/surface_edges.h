#pragma once

#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::render {

struct Edge {
  int first, second;             // nodes at its ends, first < second
  int middle;                    // node, or -1 in surfaces of order 1
  int triangle, other_triangle;  // other_triangle is -1 at the rim of an open surface
};

// The edges of a surface, sorted by their nodes. They are collected anew for another surface only.
class SurfaceEdges {
 public:
  const std::vector<Edge>& Of(const mesh::Surface& surface);

 private:
  Eigen::MatrixXi triangles_;  // of the surface that they are of
  std::vector<Edge> edges_;
};

}  // namespace softforce::render
