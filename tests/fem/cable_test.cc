#include <gtest/gtest.h>

#include "softforce/fem/static_solver.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

// A bar with a cable along its upper side: attached at the tip, through a via point, to a guide
// behind its foot.
Body BarWithCable() {
  Body bar = testing::MakeBar();
  bar.cables.push_back(
      {"upper",
       {testing::PointOf(bar, {0.1, 0.005, 0.01}), testing::PointOf(bar, {0.05, 0.005, 0.01})},
       {-0.02, 0.005, 0.02}});
  return bar;
}

LoadCase Command(const Body& body, CableInput input, double value) {
  LoadCase load = testing::LoadAt(body, {}, Eigen::Vector3d::Zero());
  load.actuation.cables[0] = {input, value};
  return load;
}

TEST(Cable, PullsTheTipTowardsTheGuide) {
  const Body body = BarWithCable();
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();

  ASSERT_TRUE(solver.Solve(Command(body, CableInput::kTension, 0.2), &state).ok());

  EXPECT_GT(body.cables[0].points[0].Apply(state.u).z(), 1e-3);  // m
  EXPECT_GT(state.shortening(0), 0);
  EXPECT_DOUBLE_EQ(state.tension(0), 0.2);
}

TEST(Cable, ByDisplacementNeedsTheTensionThatMakesThatDisplacement) {
  const Body body = BarWithCable();
  StaticSolver solver(body, "body");
  Equilibrium pulled = solver.AtRest();
  ASSERT_TRUE(solver.Solve(Command(body, CableInput::kTension, 0.2), &pulled).ok());
  Equilibrium shortened = solver.AtRest();

  ASSERT_TRUE(
      solver.Solve(Command(body, CableInput::kDisplacement, pulled.shortening(0)), &shortened)
          .ok());

  EXPECT_NEAR(shortened.tension(0), 0.2, 1e-6);                       // N
  EXPECT_LT((shortened.u - pulled.u).cwiseAbs().maxCoeff(), 1e-7);    // m
  EXPECT_NEAR(shortened.shortening(0), pulled.shortening(0), 1e-10);  // m
}

TEST(Cable, NeverPushes) {
  const Body body = BarWithCable();
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();

  ASSERT_TRUE(
      solver.Solve(Command(body, CableInput::kDisplacement, -2e-3), &state).ok());  // let out

  EXPECT_EQ(state.tension(0), 0);
  EXPECT_LT(state.u.cwiseAbs().maxCoeff(), 1e-9);  // m
}

TEST(Cable, GoesSlackAndTightAgain) {
  const Body body = BarWithCable();
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();
  for (const double shortening : {1e-3, -1e-3, 2e-3, 0.0, 3e-3}) {
    ASSERT_TRUE(solver.Solve(Command(body, CableInput::kDisplacement, shortening), &state).ok());
    EXPECT_GE(state.tension(0), 0);
    EXPECT_GE(state.shortening(0), shortening - 1e-9);
    EXPECT_EQ(state.tension(0) > 0, shortening > 0);
  }
}

TEST(Cable, SensitivityHoldsTheCommandedDisplacement) {
  const Body body = BarWithCable();
  StaticSolver solver(body, "body");
  const auto tip = testing::PointOf(body, {0.1, 0.0, 0.005});
  LoadCase load = testing::LoadAt(body, tip, {0, 0.004, -0.01});
  load.actuation.cables[0] = {CableInput::kDisplacement, 3e-3};
  Equilibrium state = solver.AtRest();
  ASSERT_TRUE(solver.Solve(load, &state).ok());
  ASSERT_GT(state.tension(0), 0);
  const Eigen::MatrixXd column =
      testing::LoadAt(body, tip, Eigen::Vector3d::UnitZ()).forces.reshaped();

  const Sensitivity sensitivity = solver.Solve(state, column, 0);

  const double h = 1e-5;  // N
  Equilibrium up = state, down = state;
  LoadCase more = load, less = load;
  more.forces += h * column.reshaped(3, body.mesh.num_nodes());
  less.forces -= h * column.reshaped(3, body.mesh.num_nodes());
  ASSERT_TRUE(solver.Solve(more, &up).ok());
  ASSERT_TRUE(solver.Solve(less, &down).ok());
  const Eigen::VectorXd slope = ((up.u - down.u) / (2 * h)).reshaped();
  EXPECT_LT((sensitivity.du - slope).norm(), 1e-4 * slope.norm());
  const double d_tension = (up.tension(0) - down.tension(0)) / (2 * h);
  EXPECT_NEAR(sensitivity.d_tension(0, 0), d_tension, 1e-4 * std::abs(d_tension));
}

}  // namespace
}  // namespace softforce::fem
