#pragma once

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "softforce/fem/body.h"
#include "softforce/mesh/surface.h"
#include "support/box_mesh.h"

namespace softforce::testing {

// A cube of edge 2 · `half` (m) around the origin without its inner half: a closed hollow of edge
// `half`. An octant of n × n × n bricks (n even) and its mirror images, so that no tetrahedron
// crosses a plane of symmetry or a diagonal plane of the cube.
inline mesh::TetMesh MakeHollowBox(int n, double half) {
  const mesh::TetMesh octant = MakeBox(n, n, n, Eigen::Vector3d::Constant(half));
  std::map<std::array<long, 3>, int> number;  // by place in units of the bricks
  std::vector<Eigen::Vector3d> nodes;
  std::vector<Eigen::Vector4i> elements;
  for (int mirror = 0; mirror < 8; ++mirror) {
    const Eigen::Vector3d sign(mirror & 1 ? -1 : 1, mirror & 2 ? -1 : 1, mirror & 4 ? -1 : 1);
    for (int e = 0; e < octant.num_elements(); ++e) {
      const Eigen::Matrix<double, 3, 4> corners = octant.nodes(Eigen::all, octant.elements.col(e));
      if (corners.rowwise().mean().maxCoeff() < half / 2) continue;
      Eigen::Vector4i element;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d place = sign.cwiseProduct(corners.col(i));
        const Eigen::Array3d units = place.array() * n / half;
        const auto [found, is_new] = number.try_emplace(
            {std::lround(units.x()), std::lround(units.y()), std::lround(units.z())},
            static_cast<int>(nodes.size()));
        if (is_new) nodes.push_back(place);
        element(i) = found->second;
      }
      if (sign.prod() < 0) std::swap(element(1), element(2));
      elements.push_back(element);
    }
  }
  mesh::TetMesh hollow;
  hollow.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (size_t i = 0; i < nodes.size(); ++i) hollow.nodes.col(static_cast<int>(i)) = nodes[i];
  hollow.elements.resize(4, static_cast<Eigen::Index>(elements.size()));
  for (size_t e = 0; e < elements.size(); ++e) {
    hollow.elements.col(static_cast<int>(e)) = elements[e];
  }
  hollow.region.assign(elements.size(), 0);
  hollow.region_names = {""};
  return hollow;
}

// The walls of the hollow of such a mesh, of order 1 or 2.
inline fem::Chamber HollowOf(const mesh::TetMesh& mesh, double half) {
  const mesh::Surface surface = mesh::ExtractSurface(mesh);
  std::vector<int> walls;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    double furthest = 0;
    for (int i = 0; i < 3; ++i) {
      furthest =
          std::max(furthest, mesh.nodes.col(surface.triangles(i, t)).lpNorm<Eigen::Infinity>());
    }
    if (furthest < 0.75 * half) walls.push_back(t);
  }
  return {"hollow", surface.triangles(Eigen::all, walls)};
}

}  // namespace softforce::testing
