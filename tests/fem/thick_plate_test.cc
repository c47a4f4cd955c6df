// NAFEMS benchmark LE10: a thick elliptic plate with an elliptic hole under pressure on its upper
// face. The figure is a stress, at the hole's edge: displacements alone would not show a wrong one.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/reference_problem.h"

namespace softforce::fem {
namespace {

constexpr double kThickness = 0.6;  // m

bool OnRim(const Eigen::Vector3d& X) {
  return std::abs(std::pow(X.x() / 3.25, 2) + std::pow(X.y() / 2.75, 2) - 1) < testing::kOnPlane;
}

// A quarter of the plate in radial × angular × vertical bricks, finer towards the hole.
Body QuarterPlate(int radial, int angular, int vertical) {
  Body body;
  body.mesh = testing::MapBox({radial, angular, vertical}, 2,
                              [](const Eigen::Vector3d& X) -> Eigen::Vector3d {
                                const double angle = M_PI / 2 * X.y();
                                const double out = 0.5 * X.x() * (1 + X.x());
                                return {(2 + 1.25 * out) * std::cos(angle),
                                        (1 + 1.75 * out) * std::sin(angle), kThickness * X.z()};
                              });
  body.materials = {{MaterialModel::kStVenantKirchhoff, 210e9, 0.3}};
  testing::HoldComponent(&body, 0, [](const Eigen::Vector3d& X) { return X.x() < 1e-9; });
  testing::HoldComponent(&body, 1, [](const Eigen::Vector3d& X) { return X.y() < 1e-9; });
  testing::HoldComponent(&body, 0, OnRim);
  testing::HoldComponent(&body, 1, OnRim);
  testing::HoldComponent(&body, 2, [](const Eigen::Vector3d& X) {
    return OnRim(X) && std::abs(X.z() - kThickness / 2) < testing::kOnPlane;
  });
  return body;
}

// Cauchy stress at a node, Pa: the mean over the cells that meet there.
Eigen::Matrix3d StressAt(const Body& body, const Eigen::Matrix3Xd& u, int node) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  int cells = 0;
  for (int cell = 0; cell < body.mesh.num_elements(); ++cell) {
    for (int corner = 0; corner < 4; ++corner) {
      if (body.mesh.elements(corner, cell) != node) continue;
      const auto point = testing::PointInCell(body.mesh, cell, Eigen::Vector4d::Unit(corner));
      const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() +
                                testing::OfCell(body.mesh, cell, u) * point.gradient.transpose();
      const MaterialResponse response = Evaluate(body.materials[0], F, false);
      sum += response.P * F.transpose() / F.determinant();
      ++cells;
    }
  }
  EXPECT_GT(cells, 0);
  return sum / cells;
}

TEST(ThickPlate, HasTheStressOfNafemsLe10) {
  const Body body = QuarterPlate(12, 18, 6);
  const LoadCase load = testing::TractionOn(body, {0, 0, -1e6}, [](const Eigen::Vector3d& X) {
    return X.z() > kThickness - testing::kOnPlane;
  });

  const Equilibrium state = testing::SolveFromRest(body, load);

  const int point_d = testing::NodeAt(body.mesh, {2, 0, kThickness});
  const double stress = StressAt(body, state.u, point_d)(1, 1) / 1e6;
  // Stress at a corner of the body converges slowly: +1.3, −0.9, −0.5, −0.3 % at 4, 8, 12, 16
  // radial bricks. The figure itself has three digits.
  EXPECT_LT(std::abs(testing::Compare("NAFEMS LE10, sigma_yy at D, MPa", stress, -5.38)), 0.01);
}

}  // namespace
}  // namespace softforce::fem
