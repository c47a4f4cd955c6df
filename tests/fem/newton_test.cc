// Tangents that leave nothing out make Newton's method converge quadratically.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "softforce/fem/static_solver.h"
#include "support/figures.h"
#include "support/hollow_box.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

struct Loading {
  const char* name;
  std::function<LoadCase(const Body&)> load;
};

std::ostream& operator<<(std::ostream& out, const Loading& loading) { return out << loading.name; }

constexpr double kHalf = 0.02;  // m

// A hollow box held below, with a cable over its side through a via point.
Body BoxWithEverything() {
  Body body;
  body.mesh = mesh::RaiseOrder(testing::MakeHollowBox(2, kHalf));
  body.materials = {testing::Silicone()};
  body.density = 1000;
  body.gravity = {2, 0, -9.81};
  body.chambers = {testing::HollowOf(body.mesh, kHalf)};
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (body.mesh.nodes(2, node) < -kHalf + 1e-9) body.fixed_nodes.push_back(node);
  }
  body.cables.push_back({"side",
                         {testing::PointOf(body, {0.005, 0.002, kHalf}),
                          testing::PointOf(body, {kHalf, 0.004, 0.004})},
                         {0.03, 0.01, -kHalf}});
  return body;
}

// The largest movement of a node in each of the first iterations from rest, m.
std::vector<double> Moves(const Body& body, const LoadCase& load, int iterations) {
  std::vector<double> moves;
  for (int k = 1; k <= iterations; ++k) {
    StaticSolverOptions options;
    options.factorisation_worth = 0;
    options.tolerance = 1e-15;
    options.max_iterations = k;
    options.max_load_halvings = 0;
    StaticSolver solver(body, "box", options);
    Equilibrium state = solver.AtRest();
    moves.push_back(solver.Solve(load, &state).last_step);
  }
  return moves;
}

class Newton : public ::testing::TestWithParam<Loading> {};

TEST_P(Newton, ConvergesQuadratically) {
  const Body body = BoxWithEverything();
  const std::vector<double> moves = Moves(body, GetParam().load(body), 7);

  // The best order between three steps in a row, above what single precision lets through.
  double order = 0;
  for (size_t k = 2; k < moves.size() && moves[k] > 1e-6 * moves[k - 1]; ++k) {
    order =
        std::max(order, std::log(moves[k] / moves[k - 1]) / std::log(moves[k - 1] / moves[k - 2]));
  }
  EXPECT_GT(testing::Record("order of convergence", order), 1.7);
}

INSTANTIATE_TEST_SUITE_P(
    Loadings, Newton,
    ::testing::Values(
        Loading{
            "force",
            [](const Body& body) {
              return testing::LoadAt(body, testing::PointOf(body, {0, 0, kHalf}), {0.5, 0.3, -1});
            }},
        Loading{"tension",
                [](const Body& body) {
                  LoadCase load = OwnWeight(body);
                  load.actuation.cables[0] = {CableInput::kTension, 2};
                  return load;
                }},
        Loading{"shortening",
                [](const Body& body) {
                  LoadCase load = OwnWeight(body);
                  load.actuation.cables[0] = {CableInput::kDisplacement, 4e-3};
                  return load;
                }},
        Loading{"pressure",
                [](const Body& body) {
                  LoadCase load = OwnWeight(body);
                  load.actuation.pressures[0] = 25e3;
                  return load;
                }}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace softforce::fem
