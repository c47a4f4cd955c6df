// A bar pulled and pushed, its sides free: the stress of each elastic law, through the solver.
#include <gtest/gtest.h>

#include "support/reference_problem.h"

namespace softforce::fem {
namespace {

struct Law {
  MaterialModel model;
  double stress_kpa[4];  // nominal, at the stretches below
};
constexpr double kStretches[] = {0.7, 0.9, 1.1, 1.3};

class UniaxialBar : public ::testing::TestWithParam<Law> {};

TEST_P(UniaxialBar, PullsAsItsLawSays) {
  // The ends stay flat: pressed to 0.7 by a dead load, a free end of the neo-Hookean laws is not
  // stable, and crumples.
  const double length = 0.02, side = 0.01;  // m
  Body body;
  body.mesh = mesh::RaiseOrder(testing::MakeBox(2, 1, 1, {length, side, side}));
  body.materials = {{GetParam().model, 220e3, 0.45}};
  const auto at_end = [](const Eigen::Vector3d& X) { return X.x() > 0.02 - testing::kOnPlane; };
  testing::HoldComponent(&body, 0, [](const Eigen::Vector3d& X) { return X.x() < 1e-9; });
  testing::HoldComponent(&body, 0, at_end);
  testing::HoldComponent(&body, 1, [](const Eigen::Vector3d& X) { return X.y() < 1e-9; });
  testing::HoldComponent(&body, 2, [](const Eigen::Vector3d& X) { return X.z() < 1e-9; });
  StaticSolver solver(body, "body");
  for (int i = 0; i < 4; ++i) {
    Equilibrium state = solver.AtRest();
    // The sides have to find their place; they start on the way to it, since St. Venant and
    // Kirchhoff's law pressed to 0.7 without giving way sideways is not stable.
    const Eigen::Vector3d start = (kStretches[i] - 1) * Eigen::Vector3d(1, -0.3, -0.3);
    state.u = start.asDiagonal() * body.mesh.nodes;

    const SolveSummary summary = solver.Solve(testing::NoLoad(body), &state);

    ASSERT_TRUE(summary.ok()) << summary.BriefReport();
    const Eigen::Matrix3Xd forces = solver.InternalForces(state.u);
    double pull = 0;  // N
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      if (at_end(body.mesh.nodes.col(node))) pull += forces(0, node);
    }
    const double stress_kpa = 1e-3 * pull / (side * side);
    testing::Compare("Stress at stretch " + std::to_string(kStretches[i]).substr(0, 3) + ", kPa",
                     stress_kpa, GetParam().stress_kpa[i], "reference");
    EXPECT_NEAR(stress_kpa, GetParam().stress_kpa[i], 1e-3);  // kPa, the reference's last digit
  }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, UniaxialBar,
    ::testing::Values(Law{MaterialModel::kNeoHookeanLogarithmic,
                          {-95.467, -24.357, 20.175, 52.660}},
                      Law{MaterialModel::kNeoHookean, {-98.886, -24.600, 19.996, 51.370}},
                      Law{MaterialModel::kStVenantKirchhoff, {-39.270, -18.810, 25.410, 98.670}},
                      Law{MaterialModel::kCorotational, {-66, -22, 22, 66}}),
    [](const auto& instance) { return std::string(Name(instance.param.model)); });

}  // namespace
}  // namespace softforce::fem
