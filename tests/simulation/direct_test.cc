#include "softforce/simulation/direct.h"

#include <gtest/gtest.h>

#include "softforce/base/input_error.h"
#include "support/box_mesh.h"

namespace softforce::simulation {
namespace {

constexpr double kSide = 0.02, kLength = 0.1;  // m

// A bar along x that is clamped at x = 0, and the middle of its other end.
struct Bar {
  fem::Body body;
  mesh::NodalWeights tip;
};

Bar MakeBar(fem::MaterialModel model) {
  Bar bar;
  bar.body.mesh = mesh::RaiseOrder(testing::MakeBox(5, 1, 1, {kLength, kSide, kSide}));
  bar.body.materials = {{model, 3e5, 0.3}};
  for (int i = 0; i < bar.body.mesh.num_nodes(); ++i) {
    if (bar.body.mesh.nodes(0, i) < 1e-9) bar.body.fixed_nodes.push_back(i);
  }
  const mesh::Surface surface = mesh::ExtractSurface(bar.body.mesh);
  const Eigen::Vector3d place(kLength, kSide / 2, kSide / 2);
  const auto at = mesh::ClosestSurfacePoint(surface, bar.body.mesh.nodes, place).at;
  bar.tip = mesh::PatchWeights(surface, bar.body.mesh.nodes, at, kSide / 2);
  return bar;
}

TEST(DirectProblem, BalancesItsLoadTightly) {
  const Bar bar = MakeBar(fem::MaterialModel::kNeoHookean);
  DirectProblem direct(bar.body, {bar.tip}, "bar");
  const Eigen::Vector3d force(0.1, 0, -0.2);  // N

  const Eigen::Matrix3Xd u = direct.Solve(0, {force, {}}).u;

  // The clamp takes all of the force: Newton's third law, in the residual of the whole body. N; a
  // node that is 1e-9 of the diagonal off is held back by some 1e-7 N.
  fem::StaticSolver solver(bar.body, "bar");
  const Eigen::Matrix3Xd inner = solver.InternalForces(u);
  Eigen::Vector3d free_sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < bar.body.mesh.num_nodes(); ++i) {
    if (bar.body.mesh.nodes(0, i) >= 1e-9) free_sum += inner.col(i);
  }
  EXPECT_LT(std::min((free_sum - force).norm(), (free_sum + force).norm()), 1e-6);
  EXPECT_LT(bar.tip.Apply(u).z(), -0.001);  // m
}

TEST(DirectProblem, DoesNotDependOnTheWayToALoad) {
  const Bar bar = MakeBar(fem::MaterialModel::kNeoHookean);
  DirectProblem gentle(bar.body, {bar.tip}, "bar"), at_once(bar.body, {bar.tip}, "bar");
  const Eigen::Vector3d force(0, 0, -0.3);  // N
  for (int frame = 0; frame < 4; ++frame) gentle.Solve(frame, {0.25 * (frame + 1) * force, {}});

  const Eigen::Matrix3Xd u = at_once.Solve(0, {force, {}}).u;

  const double difference = (gentle.Solve(4, {force, {}}).u - u).cwiseAbs().maxCoeff();
  EXPECT_LT(difference, 1e-9);  // m; ten times the tolerance on a diagonal of 0.1 m
}

TEST(DirectProblem, NamesTheFrameThatHasNoEquilibrium) {
  const Bar bar = MakeBar(fem::MaterialModel::kStVenantKirchhoff);
  DirectProblem direct(bar.body, {bar.tip}, "bar");
  direct.Solve(0, {Eigen::Vector3d(-0.1, 0, 0), {}});

  // StVK has no answer to a push of a sixth of E times the section: it gives way in compression.
  const Eigen::Vector3d crush(-100, 0, 0);  // N
  try {
    direct.Solve(7, {crush, {}});
    FAIL() << "an equilibrium was found";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bar: frame 7"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace softforce::simulation
