// What every cell and every elastic law has to do exactly, whatever the shape of the cells.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <tuple>

#include "softforce/fem/static_solver.h"
#include "support/every_model.h"
#include "support/figures.h"
#include "support/irregular_patch.h"

namespace softforce::fem {
namespace {

class EveryModelAndOrder : public ::testing::TestWithParam<std::tuple<MaterialModel, int>> {
 protected:
  Body Patch() const { return testing::IrregularPatch(std::get<0>(GetParam()), order()); }
  int order() const { return std::get<1>(GetParam()); }
};

TEST_P(EveryModelAndOrder, AnAffineDeformationIsReproducedExactly) {
  // The boundary is turned, stretched and sheared; the inside starts 0.3 mm from where it has to
  // go.
  const Body body = Patch();
  Eigen::Matrix3d A;
  A << 0.1, 0.05, 0, -0.02, -0.05, 0.03, 0.04, 0, 0.08;
  const Eigen::Matrix3d F = Eigen::AngleAxisd(1.1, Eigen::Vector3d(2, -1, 1).normalized()) *
                            (Eigen::Matrix3d::Identity() + A);
  const Eigen::Matrix3Xd affine = (F - Eigen::Matrix3d::Identity()) * body.mesh.nodes;
  StaticSolverOptions options;
  options.tolerance = 1e-12;
  StaticSolver solver(body, "body", options);
  Equilibrium state = solver.AtRest();
  state.u = affine + testing::Unevenness(body, 3e-4);

  const SolveSummary summary = solver.Solve(LoadCase{state.load}, &state);

  ASSERT_TRUE(summary.ok()) << summary.BriefReport();
  const double error = testing::Record("affine patch, m", (state.u - affine).cwiseAbs().maxCoeff());
  EXPECT_LT(error,
            1e-13);  // m; the solver stops at 1e-12 of a diagonal of 5 cm, twice that at most
}

TEST_P(EveryModelAndOrder, ARigidMotionMakesNoForce) {
  const Body body = Patch();
  const StaticSolver solver(body, "body");
  double largest = 0;
  for (const double angle : {0.1, 1.3, 3.1}) {
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Eigen::Matrix3Xd u = ((R - Eigen::Matrix3d::Identity()) * body.mesh.nodes).colwise() +
                               Eigen::Vector3d(0.1, -0.2, 0.3);

    largest = std::max(largest, solver.InternalForces(u).cwiseAbs().maxCoeff());
  }
  // Displacements of 0.4 m carry a round-off of 1e-16 m: over cells of 1 cm a strain of 1e-14, and
  // 1e-12 N with 1 MPa (the modulus of volume change at this Poisson's ratio) on 1 cm².
  EXPECT_LT(testing::Record("rigid motion, N", largest), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Patch, EveryModelAndOrder, testing::EveryModelInBothOrders(),
                         testing::NameOfModelAndOrder);

}  // namespace
}  // namespace softforce::fem
