#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::testing {

// A box with one corner at the origin and the opposite one at `size` (m), cut into nx × ny × nz
// bricks of 6 four-node tetrahedra each: neighbours share whole faces. Node (i, j, k) has number i
// + (nx + 1) · (j + (ny + 1) · k). One unnamed region; surface groups "bottom" (z = 0) and "top".
inline mesh::TetMesh MakeBox(int nx, int ny, int nz, const Eigen::Vector3d& size) {
  const auto number = [=](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };

  mesh::TetMesh box;
  box.nodes.resize(3, (nx + 1) * (ny + 1) * (nz + 1));
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Eigen::Vector3d share(double(i) / nx, double(j) / ny, double(k) / nz);
        box.nodes.col(number(i, j, k)) = share.cwiseProduct(size);
      }
    }
  }

  // Each tetrahedron is a walk from brick corner (0, 0, 0) to (1, 1, 1), one axis after another;
  // the odd orders of the axes mirror, so two of their nodes change places.
  constexpr std::array<std::array<int, 3>, 6> kWalks{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  box.elements.resize(4, 6 * nx * ny * nz);
  int e = 0;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        for (int w = 0; w < 6; ++w, ++e) {
          std::array<int, 3> at{i, j, k};
          box.elements(0, e) = number(at[0], at[1], at[2]);
          for (int step = 0; step < 3; ++step) {
            ++at[kWalks[w][step]];
            box.elements(step + 1, e) = number(at[0], at[1], at[2]);
          }
          if (w >= 3) std::swap(box.elements(1, e), box.elements(2, e));
        }
        // The bricks' diagonals in z = const run from (0, 0) to (1, 1).
        for (const auto& [name, level] : {std::pair("bottom", 0), std::pair("top", nz)}) {
          if (k != 0) continue;
          const int a = number(i, j, level), b = number(i + 1, j, level);
          const int c = number(i + 1, j + 1, level), d = number(i, j + 1, level);
          box.surface_groups[name].push_back({a, b, c});
          box.surface_groups[name].push_back({a, c, d});
        }
      }
    }
  }
  box.region.assign(box.num_elements(), 0);
  box.region_names = {""};
  return box;
}

// The same cells with every node X moved to place(X). Of a box whose order has been raised this
// makes cells with curved edges.
template <typename Map>
mesh::TetMesh MapNodes(mesh::TetMesh mesh, const Map& place) {
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const Eigen::Vector3d X = mesh.nodes.col(node);
    mesh.nodes.col(node) = place(X);
  }
  return mesh;
}

// A unit box of n1 × n2 × n3 bricks with 4- or 10-node cells, mapped by `place`.
template <typename Map>
mesh::TetMesh MapBox(const std::array<int, 3>& n, int order, const Map& place) {
  const mesh::TetMesh box = MakeBox(n[0], n[1], n[2], Eigen::Vector3d::Ones());
  return MapNodes(order == 2 ? mesh::RaiseOrder(box) : box, place);
}

}  // namespace softforce::testing
