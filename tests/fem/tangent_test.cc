// The tangent against central differences of the forces, far from rest. It is seen through the
// solver's sensitivity: K⁻¹ times the difference quotients of the forces has to be the identity.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <tuple>

#include "fem/tangent_product.h"
#include "softforce/fem/static_solver.h"
#include "support/every_model.h"
#include "support/figures.h"
#include "support/irregular_patch.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

std::vector<int> FreeComponents(const Body& body) {
  std::vector<char> held(body.mesh.num_nodes(), 0);
  for (const int node : body.fixed_nodes) held[node] = 1;
  std::vector<int> free;
  for (int i = 0; i < 3 * body.mesh.num_nodes(); ++i) {
    if (!held[i / 3]) free.push_back(i);
  }
  return free;
}

// Columns: the central difference of forces(u) by each of the components.
template <typename Forces>
Eigen::MatrixXd DifferenceQuotients(const Eigen::Matrix3Xd& u, const std::vector<int>& components,
                                    double h, const Forces& forces) {
  Eigen::MatrixXd K(u.size(), components.size());
  for (size_t i = 0; i < components.size(); ++i) {
    Eigen::Matrix3Xd up = u, down = u;
    up(components[i]) += h;
    down(components[i]) -= h;
    K.col(i) = (forces(up) - forces(down)).reshaped() / (2 * h);
  }
  return K;
}

// The largest entry of K⁻¹ · (difference quotients) − 1 on the free components.
double WorstEntry(const Sensitivity& sensitivity, const std::vector<int>& free) {
  const Eigen::MatrixXd product = sensitivity.du(free, Eigen::all);
  return (product - Eigen::MatrixXd::Identity(free.size(), free.size())).cwiseAbs().maxCoeff();
}

class Tangent : public ::testing::TestWithParam<std::tuple<MaterialModel, int>> {};

TEST_P(Tangent, IsTheDerivativeOfTheForcesFarFromRest) {
  const auto [model, order] = GetParam();
  const Body body = testing::IrregularPatch(model, order);
  Eigen::Matrix3d stretched, squeezed;
  stretched << 0.4, 0.2, 0, -0.1, 0.1, 0.15, 0.1, 0, 0.3;
  // Flattened, nearly keeping its volume: pressed from all sides the tangent of the laws that know
  // no limit of compression is indefinite, and the solver rightly says so.
  squeezed << -0.35, 0.1, 0, 0.1, 0.2, 0.05, 0, -0.1, 0.15;
  for (const Eigen::Matrix3d& A : {stretched, squeezed}) {
    const Eigen::Matrix3d F = Eigen::AngleAxisd(2, Eigen::Vector3d(2, -1, 1).normalized()) *
                              (Eigen::Matrix3d::Identity() + A);
    StaticSolver solver(body, "body");
    Equilibrium state = solver.AtRest();
    state.u = (F - Eigen::Matrix3d::Identity()) * body.mesh.nodes + testing::Unevenness(body, 3e-4);
    const std::vector<int> free = FreeComponents(body);
    const double h = 1e-7;  // m
    const Eigen::MatrixXd K = DifferenceQuotients(
        state.u, free, h, [&](const Eigen::Matrix3Xd& u) { return solver.InternalForces(u); });

    const Sensitivity sensitivity = solver.Solve(state, K, 0);

    ASSERT_TRUE(sensitivity.ok);
    // Central differences of 1e-7 m on cells of 5 mm: (2e-5)², times the laws' higher derivatives.
    EXPECT_LT(testing::Record("tangent, worst entry", WorstEntry(sensitivity, free)), 1e-7);
  }
}

// The laws without a limit of compression have an indefinite tangent here: seen as assembled.
TEST_P(Tangent, IsTheDerivativeOfTheForcesWhenPressedFromAllSides) {
  const auto [model, order] = GetParam();
  const Body body = testing::IrregularPatch(model, order);
  const Eigen::Matrix3Xd u = -0.3 * body.mesh.nodes + testing::Unevenness(body, 3e-4);
  Eigen::Matrix3Xd direction = testing::Unevenness(body, 1);
  for (const int node : body.fixed_nodes) direction.col(node).setZero();
  const StaticSolver solver(body, "body");
  const double h = 1e-7;  // m
  Eigen::Matrix3Xd difference =
      (solver.InternalForces(u + h * direction) - solver.InternalForces(u - h * direction)) /
      (2 * h);
  for (const int node : body.fixed_nodes) difference.col(node).setZero();

  const Eigen::Matrix3Xd product = testing::TangentTimes(body, u, {}, {}, direction);

  // As above; and rounding, of forces in which much cancels.
  EXPECT_LT((product - difference).colwise().norm().maxCoeff(),
            1e-6 * difference.colwise().norm().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Models, Tangent, testing::EveryModelInBothOrders(),
                         testing::NameOfModelAndOrder);

// What a cable under a tension of 1 that runs freely through its points asks of the nodes to
// resist: at each point, the two directions in which the cable leaves it.
Eigen::Matrix3Xd PullOf(const Cable& cable, const Eigen::Matrix3Xd& x) {
  std::vector<Eigen::Vector3d> path;
  for (const mesh::NodalWeights& point : cable.points) path.push_back(point.Apply(x));
  path.push_back(cable.guide);
  Eigen::Matrix3Xd pull = Eigen::Matrix3Xd::Zero(3, x.cols());
  for (size_t i = 0; i < cable.points.size(); ++i) {
    Eigen::Vector3d at_point = (path[i] - path[i + 1]).normalized();
    if (i > 0) at_point += (path[i] - path[i - 1]).normalized();
    const mesh::NodalWeights& point = cable.points[i];
    for (size_t k = 0; k < point.nodes.size(); ++k) {
      pull.col(point.nodes[k]) += point.weights[k] * at_point;
    }
  }
  return pull;
}

class CableTangent : public ::testing::TestWithParam<int> {
 protected:
  // A bar with a cable that winds along it through two via points.
  static Body WoundBar(int order) {
    Body bar = testing::MakeBar(order, 5);
    bar.cables.push_back(
        {"wound",
         {testing::PointOf(bar, {0.1, 0.005, 0.01}), testing::PointOf(bar, {0.06, 0.01, 0.007}),
          testing::PointOf(bar, {0.03, 0.006, 0.01})},
         {-0.02, 0.012, 0.02}});
    return bar;
  }
};

TEST_P(CableTangent, IsTheDerivativeOfTheForcesUnderLargeTension) {
  const Body body = WoundBar(GetParam());
  StaticSolverOptions options;
  options.tolerance = 1e-11;
  StaticSolver solver(body, "body", options);
  Equilibrium state = solver.AtRest();
  LoadCase load = state.load;
  const double tension = 0.5;  // N
  load.actuation.cables[0] = {CableInput::kTension, tension};
  const SolveSummary summary = solver.Solve(load, &state);
  ASSERT_TRUE(summary.ok()) << summary.BriefReport();
  const Cable& cable = body.cables[0];
  ASSERT_GT(cable.points[0].Apply(state.u).norm(), 0.01);  // m; bent by more than its thickness

  const auto forces = [&](const Eigen::Matrix3Xd& u) -> Eigen::Matrix3Xd {
    return solver.InternalForces(u) + tension * PullOf(cable, body.mesh.nodes + u);
  };
  const std::vector<int> free = FreeComponents(body);
  const double unbalanced = forces(state.u).reshaped()(free).cwiseAbs().maxCoeff();
  // The solver stops within 1e-12 m; the stiffness of a cell, 200 kPa · 1 cm, makes that 2e-9 N.
  EXPECT_LT(testing::Record("unbalanced force, N", unbalanced), 2e-9);

  const double h = 1e-7;  // m
  const Eigen::MatrixXd K = DifferenceQuotients(state.u, free, h, forces);
  const Sensitivity sensitivity = solver.Solve(state, K, 0);

  ASSERT_TRUE(sensitivity.ok);
  // The bar is soft in bending, which magnifies the error of the differences a hundredfold.
  EXPECT_LT(testing::Record("tangent, worst entry", WorstEntry(sensitivity, free)), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Orders, CableTangent, ::testing::Values(1, 2));

}  // namespace
}  // namespace softforce::fem
