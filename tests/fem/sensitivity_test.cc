#include <gtest/gtest.h>

#include "softforce/base/input_error.h"
#include "softforce/fem/static_solver.h"
#include "support/hollow_box.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

StaticSolverOptions Exact() {
  StaticSolverOptions exact;
  exact.tolerance = 1e-12;
  return exact;
}

// A bar with a cable pulled by a force and another shortened by a length.
Body BarWithTwoCables() {
  Body bar = testing::MakeBar();
  bar.cables.push_back(
      {"upper", {testing::PointOf(bar, {0.1, 0.005, 0.01})}, {-0.02, 0.005, 0.02}});
  bar.cables.push_back({"side", {testing::PointOf(bar, {0.08, 0.01, 0.005})}, {-0.02, 0.03, 0.0}});
  return bar;
}

LoadCase Driven(const Body& body, double tension, double shortening) {
  LoadCase load = OwnWeight(body);
  load.actuation.cables = {{CableInput::kTension, tension},
                           {CableInput::kDisplacement, shortening}};
  return load;
}

TEST(Sensitivity, ToActuationIsTheDifferenceQuotient) {
  const Body body = BarWithTwoCables();
  StaticSolver solver(body, "bar", Exact());
  constexpr double kTension = 0.05, kShortening = 4e-3;
  Equilibrium state = solver.AtRest();
  ASSERT_TRUE(solver.Solve(Driven(body, kTension, kShortening), &state).ok());
  ASSERT_GT(state.tension(1), 0);

  const Sensitivity response = solver.SolveActuation(state, 0);

  ASSERT_TRUE(response.ok);
  const std::array<double, 2> step{1e-4, 1e-6};  // N, m
  for (int c = 0; c < 2; ++c) {
    Equilibrium more = state, less = state;
    const double dt = c == 0 ? step[0] : 0, dd = c == 1 ? step[1] : 0;
    ASSERT_TRUE(solver.Solve(Driven(body, kTension + dt, kShortening + dd), &more).ok());
    ASSERT_TRUE(solver.Solve(Driven(body, kTension - dt, kShortening - dd), &less).ok());
    const Eigen::VectorXd du = (more.u - less.u).reshaped() / (2 * step[c]);
    const Eigen::VectorXd d_tension = (more.tension - less.tension) / (2 * step[c]);
    // The quotient's own error goes with the step squared.
    EXPECT_LT((response.du.col(c) - du).norm(), 1e-5 * du.norm());
    EXPECT_LT((response.d_tension.col(c) - d_tension).norm(), 1e-5 * d_tension.norm());
  }
}

TEST(Sensitivity, ToAPressureIsTheDifferenceQuotient) {
  constexpr double kHalf = 0.02;  // m
  Body body;
  body.mesh = mesh::RaiseOrder(testing::MakeHollowBox(2, kHalf));
  body.materials = {testing::Silicone()};
  body.chambers = {testing::HollowOf(body.mesh, kHalf)};
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (body.mesh.nodes(2, node) < -kHalf + 1e-9) body.fixed_nodes.push_back(node);
  }
  StaticSolver solver(body, "box", Exact());
  const auto at = [&](double pressure) {
    Equilibrium state = solver.AtRest();
    LoadCase load = OwnWeight(body);
    load.actuation.pressures = {pressure};
    EXPECT_TRUE(solver.Solve(load, &state).ok());
    return state;
  };
  constexpr double kPressure = 10e3, kStep = 10;  // Pa

  const Sensitivity response = solver.SolveActuation(at(kPressure), 0);

  ASSERT_TRUE(response.ok);
  const Eigen::VectorXd du =
      (at(kPressure + kStep).u - at(kPressure - kStep).u).reshaped() / (2 * kStep);
  EXPECT_LT((response.du.col(0) - du).norm(), 1e-5 * du.norm());  // the quotient's own error
}

TEST(Sensitivity, ToTheModulusFollowsFromInternalForces) {
  const Body body = testing::MakeBar();
  StaticSolver solver(body, "bar", Exact());
  const mesh::NodalWeights tip = testing::PointOf(body, {0.1, 0.005, 0.005});
  const LoadCase load = testing::LoadAt(body, tip, {0, 0, -0.02});
  Equilibrium state = solver.AtRest();
  ASSERT_TRUE(solver.Solve(load, &state).ok());
  const auto stiffer = [&](double factor) {
    std::vector<Material> materials = body.materials;
    materials[0].youngs_modulus *= factor;
    return materials;
  };
  constexpr double kStep = 1e-4;

  // ∂f_int/∂ log E
  const Eigen::VectorXd df = (solver.InternalForces(state.u, stiffer(1 + kStep)) -
                              solver.InternalForces(state.u, stiffer(1 - kStep)))
                                 .reshaped() /
                             (2 * kStep);
  const Sensitivity response = solver.Solve(state, -df, 0);

  Equilibrium more = state, less = state;
  solver.SetMaterials(stiffer(1 + kStep));
  ASSERT_TRUE(solver.Solve(load, &more).ok());
  solver.SetMaterials(stiffer(1 - kStep));
  ASSERT_TRUE(solver.Solve(load, &less).ok());
  const Eigen::VectorXd du = (more.u - less.u).reshaped() / (2 * kStep);
  EXPECT_LT((response.du.col(0) - du).norm(), 1e-5 * du.norm());  // the quotient's own error
}

TEST(StaticSolver, RefusesAMaterialOfNoUse) {
  const Body body = testing::MakeBar();
  StaticSolver solver(body, "bar");
  std::vector<Material> materials = body.materials;
  materials[0].poissons_ratio = 0.5;
  EXPECT_THROW(solver.SetMaterials(materials), base::InputError);
}

}  // namespace
}  // namespace softforce::fem
