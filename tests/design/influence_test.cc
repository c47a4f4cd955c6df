#include "softforce/design/influence.h"

#include <gtest/gtest.h>

#include "design/plate.h"

namespace softforce::design {
namespace {

// Where the points are under a small force at a place, by the equilibrium itself.
std::vector<Eigen::Vector3d> Solve(const testing::Plate& plate, const Eigen::Vector3d& place,
                                   const Eigen::Vector3d& force) {
  fem::LoadCase load{Eigen::Matrix3Xd::Zero(3, plate.body.mesh.num_nodes()),
                     fem::NoActuation(plate.body)};
  const mesh::NodalWeights at = mesh::PatchWeights(plate.surface, plate.body.mesh.nodes,
                                                   plate.At(place), testing::Plate::kPatch);
  for (size_t n = 0; n < at.nodes.size(); ++n) load.forces.col(at.nodes[n]) = at.weights[n] * force;
  fem::StaticSolverOptions options;
  options.tolerance = 1e-12;
  fem::StaticSolver solver(plate.body, "plate", options);
  fem::Equilibrium state = solver.AtRest();
  EXPECT_TRUE(solver.Solve(load, &state).ok());
  std::vector<Eigen::Vector3d> moved;
  for (const mesh::NodalWeights& point : plate.points) moved.push_back(point.Apply(state.u));
  return moved;
}

TEST(Influence, IsHowPointsMoveWithASmallForce) {
  testing::Plate plate;
  const Eigen::Vector3d place(62e-3, 29e-3, 0), force(2e-5, -1e-5, 3e-5);  // m, N
  plate.loads = {plate.LoadAt(place)};

  const Influence influence =
      ComputeInfluence(plate.solver.get(), plate.solver->AtRest(), plate.points, plate.loads);

  const auto moved = Solve(plate, place, force);
  for (size_t i = 0; i < moved.size(); ++i) {
    const Eigen::Vector3d linear = influence.At(static_cast<int>(i), 0).leftCols<3>() * force;
    // Share: what the plate's answer to 40 µN is not linear by.
    EXPECT_LT((linear - moved[i]).norm(), 1e-3 * moved.back().norm()) << i;
  }
}

TEST(Influence, IsHowPointsMoveAsTheForceSlides) {
  testing::Plate plate;
  const Eigen::Vector3d force(0, 0, 0.4), start(62e-3, 29e-3, 0);
  const double step = 2e-4;  // m
  plate.loads = {plate.LoadAt(start), plate.LoadAt(start + step * Eigen::Vector3d::UnitX()),
                 plate.LoadAt(start - step * Eigen::Vector3d::UnitX())};

  const Influence influence =
      ComputeInfluence(plate.solver.get(), plate.solver->AtRest(), plate.points, plate.loads);

  for (int i = 0; i < influence.num_points(); ++i) {
    const Eigen::Vector3d by_difference =
        (influence.At(i, 1) - influence.At(i, 2)).leftCols<3>() * force / (2 * step);
    // The triangle's tangents are its own: only how far the point moves at most is compared.
    const auto slopes = influence.At(i, 0).rightCols<2>();
    const Eigen::Vector2d along =
        (slopes.transpose() * slopes).ldlt().solve(slopes.transpose() * by_difference);
    // Share: curvature over the 0.2 mm step.
    EXPECT_LT((slopes * along - by_difference).norm(), 0.02 * by_difference.norm() + 1e-6) << i;
    EXPECT_NEAR(along.norm(), 1, 0.05) << i;
  }
}

}  // namespace
}  // namespace softforce::design
