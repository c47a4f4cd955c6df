#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>

#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"
#include "support/box_mesh.h"
#include "support/cell_points.h"
#include "support/figures.h"
#include "support/soft_bodies.h"

namespace softforce::testing {

// What the tests against published figures share: holding, loading, solving, and telling the
// result. Places and loads are in whatever unit the publication uses.

inline constexpr double kOnPlane = 1e-9;  // nodes this close to a plane lie on it

inline void HoldComponent(fem::Body* body, int axis, bool (*where)(const Eigen::Vector3d& X)) {
  for (int node = 0; node < body->mesh.num_nodes(); ++node) {
    if (where(body->mesh.nodes.col(node))) body->fixed_components.push_back({node, axis});
  }
}

inline void HoldNodes(fem::Body* body, bool (*where)(const Eigen::Vector3d& X)) {
  for (int node = 0; node < body->mesh.num_nodes(); ++node) {
    if (where(body->mesh.nodes.col(node))) body->fixed_nodes.push_back(node);
  }
}

// The node at X; none of the reference problems asks for a place where there is no node.
inline int NodeAt(const mesh::TetMesh& mesh, const Eigen::Vector3d& X) {
  int nearest = -1;
  const double squared = (mesh.nodes.colwise() - X).colwise().squaredNorm().minCoeff(&nearest);
  EXPECT_LT(squared, 1e-12 * (1 + X.squaredNorm())) << "no node at " << X.transpose();
  return nearest;
}

inline fem::LoadCase NoLoad(const fem::Body& body) {
  return LoadAt(body, {}, Eigen::Vector3d::Zero());
}

// Dead loads of a uniform traction (force per area at rest) on the part of the surface whose nodes
// all lie where `where` says, spread by the shape functions.
inline fem::LoadCase TractionOn(const fem::Body& body, const Eigen::Vector3d& traction,
                                bool (*where)(const Eigen::Vector3d& X)) {
  fem::LoadCase load = NoLoad(body);
  const mesh::Surface surface = mesh::ExtractSurface(body.mesh);
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const Eigen::VectorXi nodes = surface.triangles.col(t);
    if (!std::all_of(nodes.begin(), nodes.end(),
                     [&](int node) { return where(body.mesh.nodes.col(node)); })) {
      continue;
    }
    const Eigen::Matrix3Xd X = body.mesh.nodes(Eigen::all, nodes);
    load.forces(Eigen::all, nodes) += traction * ShapeIntegrals(X).transpose();
  }
  return load;
}

// The equilibrium under a load, from rest; the test fails where there is none.
inline fem::Equilibrium SolveFromRest(const fem::Body& body, const fem::LoadCase& load) {
  fem::StaticSolver solver(body, "body");
  fem::Equilibrium state = solver.AtRest();
  const fem::SolveSummary summary = solver.Solve(load, &state);
  EXPECT_TRUE(summary.ok()) << summary.BriefReport();
  return state;
}

}  // namespace softforce::testing
