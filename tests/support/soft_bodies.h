#pragma once

#include <cmath>

#include "softforce/fem/body.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"
#include "support/box_mesh.h"

namespace softforce::testing {

inline fem::Material Silicone() { return {fem::MaterialModel::kNeoHookean, 200e3, 0.45}; }

// A bar of silicone, 100 × 10 × 10 mm, held at x = 0.
inline fem::Body MakeBar(int order = 2, int cells_along = 10) {
  fem::Body bar;
  bar.mesh = MakeBox(cells_along, 2, 2, {0.1, 0.01, 0.01});
  if (order == 2) bar.mesh = mesh::RaiseOrder(bar.mesh);
  bar.materials = {Silicone()};
  for (int node = 0; node < bar.mesh.num_nodes(); ++node) {
    if (bar.mesh.nodes(0, node) < 1e-9) bar.fixed_nodes.push_back(node);
  }
  return bar;
}

// The surface point of a body closest to a place, as shape functions.
inline mesh::NodalWeights PointOf(const fem::Body& body, const Eigen::Vector3d& place) {
  const mesh::Surface surface = mesh::ExtractSurface(body.mesh);
  return mesh::ShapeFunctions(surface,
                              mesh::ClosestSurfacePoint(surface, body.mesh.nodes, place).at);
}

// A load of `force` (N) on a point of a body, its cables and chambers (if any) idle.
inline fem::LoadCase LoadAt(const fem::Body& body, const mesh::NodalWeights& at,
                            const Eigen::Vector3d& force) {
  fem::LoadCase load = fem::OwnWeight(body);
  for (size_t i = 0; i < at.nodes.size(); ++i)
    load.forces.col(at.nodes[i]) += at.weights[i] * force;
  return load;
}

}  // namespace softforce::testing
