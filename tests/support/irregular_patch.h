#pragma once

#include <Eigen/Core>
#include <cmath>

#include "softforce/fem/body.h"
#include "support/box_mesh.h"

namespace softforce::testing {

inline bool IsInside(const Eigen::Vector3d& X, double side) {
  return X.minCoeff() > 1e-9 && X.maxCoeff() < side - 1e-9;
}

// A cube of 3 cm of 200 kPa and Poisson's ratio 0.45 in 162 cells of unlike shapes, held at its
// whole surface.
inline fem::Body IrregularPatch(fem::MaterialModel model, int order) {
  const double side = 0.03;
  fem::Body body;
  body.mesh = MapNodes(MakeBox(3, 3, 3, {side, side, side}), [=](const Eigen::Vector3d& X) {
    const Eigen::Array3d angle = 1e3 * X.array();  // far apart for neighbours: scattered
    const Eigen::Vector3d shift(std::sin(3 * angle.x() + angle.y()),
                                std::sin(5 * angle.y() + 2 * angle.z()),
                                std::sin(7 * angle.z() + 3 * angle.x()));
    return Eigen::Vector3d(IsInside(X, side) ? X + 0.15 * side / 3 * shift : X);
  });
  if (order == 2) body.mesh = mesh::RaiseOrder(body.mesh);
  body.materials = {{model, 200e3, 0.45}};
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (!IsInside(body.mesh.nodes.col(node), side)) body.fixed_nodes.push_back(node);
  }
  return body;
}

// An uneven displacement of the nodes that are free, up to `size` (m) in each component.
inline Eigen::Matrix3Xd Unevenness(const fem::Body& body, double size) {
  Eigen::Matrix3Xd u(3, body.mesh.num_nodes());
  for (int i = 0; i < u.size(); ++i) u(i) = size * std::sin(2.3 * i);
  for (const int node : body.fixed_nodes) u.col(node).setZero();
  return u;
}

}  // namespace softforce::testing
