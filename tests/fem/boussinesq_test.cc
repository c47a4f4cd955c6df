// A force on the surface of an elastic half-space: how far around itself a touch is felt.
#include <gtest/gtest.h>

#include <cmath>

#include "support/reference_problem.h"

namespace softforce::fem {
namespace {

constexpr double kModulus = 200e3, kRatio = 0.45, kForce = 1e-6;  // Pa, –, N

// Displacement of the half-space z < 0 under a force at the origin along −z, away from the origin.
Eigen::Vector3d HalfSpace(const Eigen::Vector3d& X) {
  const double r = X.head<2>().norm(), depth = -X.z(), distance = X.norm();
  const double scale = kForce * (1 + kRatio) / (2 * M_PI * kModulus);
  const double down = scale * (2 * (1 - kRatio) / distance + depth * depth / std::pow(distance, 3));
  if (r == 0) return {0, 0, -down};
  const double out = scale * (r * depth / std::pow(distance, 3) -
                              (1 - 2 * kRatio) * r / (distance * (distance + depth)));
  return {out * X.x() / r, out * X.y() / r, -down};
}

TEST(Boussinesq, IsFeltAroundATouch) {
  // A quarter of a block of side 0.1 m below the surface, finer towards the force; its far sides
  // move as the half-space does, so that the block's being finite is no error.
  Body body;
  const double side = 0.1;
  body.mesh = testing::MapBox({10, 10, 10}, 2, [=](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    const Eigen::Array3d s(X.x(), X.y(), 1 - X.z());
    const Eigen::Array3d graded = side * s.square();
    return {graded.x(), graded.y(), -graded.z()};
  });
  body.materials = {{MaterialModel::kCorotational, kModulus, kRatio}};
  testing::HoldComponent(&body, 0, [](const Eigen::Vector3d& X) { return X.x() < 1e-9; });
  testing::HoldComponent(&body, 1, [](const Eigen::Vector3d& X) { return X.y() < 1e-9; });
  testing::HoldNodes(&body, [](const Eigen::Vector3d& X) {
    return X.x() > 0.1 - 1e-9 || X.y() > 0.1 - 1e-9 || X.z() < -0.1 + 1e-9;
  });
  StaticSolverOptions options;
  options.tolerance = 1e-12;
  StaticSolver solver(body, "body", options);
  Equilibrium state = solver.AtRest();
  for (const int node : body.fixed_nodes) state.u.col(node) = HalfSpace(body.mesh.nodes.col(node));
  LoadCase load = testing::NoLoad(body);
  load.forces(2, testing::NodeAt(body.mesh, Eigen::Vector3d::Zero())) = -kForce / 4;

  const SolveSummary summary = solver.Solve(load, &state);

  ASSERT_TRUE(summary.ok()) << summary.BriefReport();
  double worst = 0;
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    const Eigen::Vector3d X = body.mesh.nodes.col(node);
    const double r = X.norm();
    if (X.z() < -testing::kOnPlane || r < 0.01 || r > 0.07) continue;
    const double ours = -state.u(2, node);
    const double theory = (1 - kRatio * kRatio) * kForce / (M_PI * kModulus * r);
    worst = std::max(worst, std::abs(ours / theory - 1));
  }
  // The nearest of these nodes are three bricks from the force, whose infinite peak no cell
  // follows; 10 bricks a side are off by 0.6 %, 6 by 6 %.
  EXPECT_LT(testing::Record("Boussinesq, worst error of u_z between 1 and 7 cm", worst), 0.01);
}

}  // namespace
}  // namespace softforce::fem
