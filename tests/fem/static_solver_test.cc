#include "softforce/fem/static_solver.h"

#include <gtest/gtest.h>

#include "softforce/base/input_error.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

class EveryOrder : public ::testing::TestWithParam<int> {};

TEST_P(EveryOrder, SensitivityIsTheDerivativeOfTheEquilibrium) {
  const Body body = testing::MakeBar(GetParam());
  StaticSolver solver(body, "body");
  const mesh::NodalWeights tip = testing::PointOf(body, {0.1, 0.005, 0.01});
  Equilibrium state = solver.AtRest();
  const Eigen::Vector3d force(0.01, 0.005, -0.03);
  ASSERT_TRUE(solver.Solve(testing::LoadAt(body, tip, force), &state).ok());
  Eigen::MatrixXd columns(3 * body.mesh.num_nodes(), 3);
  for (int i = 0; i < 3; ++i) {
    columns.col(i) = testing::LoadAt(body, tip, Eigen::Vector3d::Unit(i)).forces.reshaped();
  }

  const Sensitivity sensitivity = solver.Solve(state, columns, 0);

  for (int i = 0; i < 3; ++i) {
    const double h = 1e-5;  // N
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
    Equilibrium up = state, down = state;
    ASSERT_TRUE(solver.Solve(testing::LoadAt(body, tip, force + step), &up).ok());
    ASSERT_TRUE(solver.Solve(testing::LoadAt(body, tip, force - step), &down).ok());
    const Eigen::VectorXd slope = ((up.u - down.u) / (2 * h)).reshaped();
    EXPECT_LT((sensitivity.du.col(i) - slope).norm(), 1e-4 * slope.norm());
  }
}

TEST_P(EveryOrder, LargeLoadsAreReachedFromRest) {
  const Body body = testing::MakeBar(GetParam());
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();
  const auto tip = testing::PointOf(body, {0.1, 0.005, 0.005});

  // P L² / (E I) = 6: the bar bends by more than 60 degrees.
  const double load = 6 * 200e3 * (1e-8 / 12) / 0.01;
  const SolveSummary summary = solver.Solve(testing::LoadAt(body, tip, {0, 0, -load}), &state);

  EXPECT_TRUE(summary.ok()) << summary.BriefReport();
}

INSTANTIATE_TEST_SUITE_P(Orders, EveryOrder, ::testing::Values(1, 2));

TEST(StaticSolver, HangsUnderItsWeight) {
  // A bar hanging along gravity: elongation rho g L² / (2 E), at small strain.
  Body body = testing::MakeBar();
  body.materials = {{MaterialModel::kNeoHookean, 2e6, 0.0}};
  body.density = 1000;
  body.gravity = {9.81, 0, 0};
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();

  ASSERT_TRUE(solver.Solve(OwnWeight(body), &state).ok());

  const double expected = 1000 * 9.81 * 0.01 / (2 * 2e6);
  const auto tip = testing::PointOf(body, {0.1, 0.005, 0.005});
  EXPECT_NEAR(tip.Apply(state.u).x(), expected, 0.002 * expected);
}

TEST(StaticSolver, GivesTheSameFromOtherStarts) {
  const Body body = testing::MakeBar();
  StaticSolver solver(body, "body");
  const auto tip = testing::PointOf(body, {0.1, 0.005, 0.005});
  const LoadCase load = testing::LoadAt(body, tip, {0, 0.01, -0.02});
  Equilibrium direct = solver.AtRest();
  ASSERT_TRUE(solver.Solve(load, &direct).ok());
  Equilibrium around = solver.AtRest();
  ASSERT_TRUE(solver.Solve(testing::LoadAt(body, tip, {0.01, -0.02, 0.03}), &around).ok());
  ASSERT_TRUE(solver.Solve(load, &around).ok());

  EXPECT_LT((direct.u - around.u).cwiseAbs().maxCoeff(), 1e-8);  // m; ten times the step tolerance
}

TEST(StaticSolver, SaysWhenItCannotAndKeepsTheLastEquilibrium) {
  const Body body = testing::MakeBar(1, 4);
  StaticSolverOptions options;
  options.max_load_halvings = 2;
  options.max_iterations = 5;
  StaticSolver solver(body, "body", options);
  Equilibrium state = solver.AtRest();
  const auto tip = testing::PointOf(body, {0.1, 0.005, 0.005});

  const SolveSummary summary = solver.Solve(testing::LoadAt(body, tip, {-500, 0, 0}), &state);

  EXPECT_FALSE(summary.ok());
  EXPECT_LT(summary.reached_share, 1);
  EXPECT_NE(summary.Advice(), "");

  // What is left is the equilibrium under the load that it names.
  StaticSolver fresh(body, "body");
  Equilibrium again = fresh.AtRest();
  ASSERT_TRUE(fresh.Solve(state.load, &again).ok());
  EXPECT_LT((again.u - state.u).cwiseAbs().maxCoeff(), 1e-6);  // m; of a bar of 0.1 m
}

// A slender strut pushed beyond Euler's load along its axis stays straight only in theory.
TEST(StaticSolver, SaysThatAStrutBuckles) {
  Body strut;
  strut.mesh = mesh::RaiseOrder(testing::MakeBox(20, 1, 1, {0.2, 0.01, 0.01}));
  strut.materials = {testing::Silicone()};
  for (int n = 0; n < strut.mesh.num_nodes(); ++n) {
    if (strut.mesh.nodes(0, n) < 1e-9) strut.fixed_nodes.push_back(n);
  }
  const auto tip = testing::PointOf(strut, {0.2, 0.005, 0.005});
  const double euler = std::pow(M_PI / 0.4, 2) * strut.materials[0].youngs_modulus * 1e-8 / 12;
  StaticSolver solver(strut, "strut");

  Equilibrium below = solver.AtRest();
  EXPECT_TRUE(solver.Solve(testing::LoadAt(strut, tip, {-0.8 * euler, 0, 0}), &below).ok());
  EXPECT_LT(below.u.row(2).cwiseAbs().maxCoeff(), 2e-3);  // m; still nearly straight

  // Beyond, the straight shape is no longer stable; the way to the bent one is not a small step.
  Equilibrium beyond = solver.AtRest();
  const SolveSummary summary =
      solver.Solve(testing::LoadAt(strut, tip, {-1.2 * euler, 0, 0}), &beyond);
  EXPECT_EQ(summary.status, SolveSummary::Status::kUnstable) << summary.BriefReport();
  EXPECT_NEAR(1.2 * summary.reached_share, 1, 0.08);  // Euler's load, of a strut 20 times as long
}  // as thick, in steps of 1/256

// A tangent made under a large tension is far too stiff for the idle body.
TEST(StaticSolver, DoesNotTakeASmallStepOfAnOldTangentForTheEnd) {
  Body body = testing::MakeBar(1, 10);
  body.cables.push_back(
      {"pull", {testing::PointOf(body, {0.1, 0.005, 0.005})}, {0.3, 0.005, 0.005}});
  const auto tip = testing::PointOf(body, {0.1, 0.005, 0.005});
  StaticSolver used(body, "body"), fresh(body, "body");
  Equilibrium pulled = used.AtRest();
  LoadCase pull = pulled.load;
  pull.actuation.cables[0] = {CableInput::kTension, 2};
  ASSERT_TRUE(used.Solve(pull, &pulled).ok());
  for (const double newtons : {1e-8, 1e-7, 1e-6}) {
    const LoadCase side = testing::LoadAt(body, tip, {0, 0, newtons});
    Equilibrium after = used.AtRest(), alone = fresh.AtRest();
    ASSERT_TRUE(used.Solve(side, &after).ok());
    ASSERT_TRUE(fresh.Solve(side, &alone).ok());
    // m; the tolerance, 1e-7 of the bar's diagonal, twice
    EXPECT_LT((after.u - alone.u).colwise().norm().maxCoeff(), 2.1e-8);
  }
}

TEST(StaticSolver, ReachesASoftBodysOwnWeightInSteps) {
  Body body = testing::MakeBar(1, 30);
  body.materials[0].youngs_modulus = 1e3;  // Pa: sags by far more than its thickness
  body.density = 1000;
  body.gravity = {0, 0, -9.81};
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();
  const SolveSummary summary = solver.Solve(OwnWeight(body), &state);
  EXPECT_TRUE(summary.ok()) << summary.BriefReport();
  EXPECT_LT(state.u.row(2).minCoeff(), -0.05);  // m
}

// Laws without a limit of compression let a dead load push a cell through itself.
TEST(StaticSolver, SaysThatACellIsCrushed) {
  Body body;
  body.mesh = testing::MakeBox(2, 2, 2, {0.02, 0.02, 0.02});
  body.materials = {{MaterialModel::kCorotational, 200e3, 0.3}};
  for (int n = 0; n < body.mesh.num_nodes(); ++n) {
    if (body.mesh.nodes(2, n) < 1e-9) body.fixed_nodes.push_back(n);
  }
  StaticSolver solver(body, "body");
  Equilibrium state = solver.AtRest();
  const auto top = testing::PointOf(body, {0.01, 0.01, 0.02});

  const SolveSummary summary = solver.Solve(testing::LoadAt(body, top, {0, 0, -40}), &state);

  ASSERT_EQ(summary.status, SolveSummary::Status::kInverted) << summary.BriefReport();
  EXPECT_GT(summary.reached_share, 0);
  EXPECT_LT(summary.reached_share, 1);
  EXPECT_GT(summary.inverted_at.z(), 0.01);  // m; in the upper half, where the load is
  EXPECT_NE(summary.Advice().find("crushed around"), std::string::npos);
}

TEST(StaticSolver, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    StaticSolverOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](StaticSolverOptions& o) { o.tolerance = 0; });
  refuses([](StaticSolverOptions& o) { o.max_iterations = 0; });
  refuses([](StaticSolverOptions& o) { o.factorisation_worth = -1; });
  refuses([](StaticSolverOptions& o) { o.max_load_halvings = -1; });
}

}  // namespace
}  // namespace softforce::fem
