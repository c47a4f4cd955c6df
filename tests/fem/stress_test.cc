// Cauchy stress at the nodes against formulas.
#include "softforce/fem/stress.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/box_mesh.h"

namespace softforce::fem {
namespace {

constexpr double kE = 220e3, kPoisson = 0.45;  // Pa, –
constexpr double kRounding = 1e-9;             // of the stress

Body Bar(MaterialModel model, int order) {
  Body body;
  body.mesh = mesh::WithOrder(testing::MakeBox(2, 2, 1, {0.02, 0.01, 0.01}), order);
  body.materials = {{model, kE, kPoisson}};
  return body;
}

Eigen::Matrix3Xd Moved(const Body& body, const Eigen::Matrix3d& F) {
  return (F - Eigen::Matrix3d::Identity()) * body.mesh.nodes;
}

class StressOfOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, StressOfOrder, ::testing::Values(1, 2));

// Stretched along x, with sides that neither pull nor push: σ = E (λ − 1) / λ_side², because the
// nominal stress is E (λ − 1), and the area has shrunk by λ_side².
TEST_P(StressOfOrder, InABarOfHookesLawIsTheForceOverTheAreaThatIsLeft) {
  const Body body = Bar(MaterialModel::kCorotational, GetParam());
  const double stretch = 1.2, side = 1 - kPoisson * 0.2;
  const double expected = kE * 0.2 / (side * side);  // Pa

  const auto stress =
      NodalStress(body, Moved(body, Eigen::Vector3d(stretch, side, side).asDiagonal()));

  for (Eigen::Index node = 0; node < stress.cols(); ++node) {
    EXPECT_NEAR(stress(0, node), expected, kRounding * expected);
    EXPECT_LT(stress.col(node).tail<5>().cwiseAbs().maxCoeff(), kRounding * expected);
    EXPECT_NEAR(VonMises(stress.col(node)), expected, kRounding * expected);
  }
}

// For any stretches σ_i = mu J^(−5/3) (λ_i² − I1/3) + kappa/2 (J − 1/J).
TEST_P(StressOfOrder, InANeoHookeanBarIsThatOfItsStretches) {
  const Body body = Bar(MaterialModel::kNeoHookean, GetParam());
  const Eigen::Vector3d stretches(1.4, 0.85, 0.9);
  const Material& material = body.materials[0];
  const double J = stretches.prod();
  const Eigen::Array3d squared = stretches.array().square();
  const Eigen::Vector3d expected =
      material.mu() * std::pow(J, -5.0 / 3) * (squared - squared.mean()) +
      0.5 * material.kappa() * (J - 1 / J);

  const auto stress = NodalStress(body, Moved(body, stretches.asDiagonal()));

  for (Eigen::Index node = 0; node < stress.cols(); ++node) {
    EXPECT_LT((stress.col(node).head<3>() - expected).norm(), kRounding * expected.norm());
    EXPECT_LT(stress.col(node).tail<3>().norm(), kRounding * expected.norm());
  }
}

TEST_P(StressOfOrder, TurnsWithTheBodyAndItsVonMisesStressStays) {
  const Body body = Bar(MaterialModel::kNeoHookean, GetParam());
  const Eigen::Matrix3d U = Eigen::Vector3d(1.3, 0.9, 0.9).asDiagonal();
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();

  const Eigen::VectorXd straight = NodalVonMises(body, Moved(body, U));
  const Eigen::VectorXd turned = NodalVonMises(body, Moved(body, R * U));

  EXPECT_LT((straight - turned).cwiseAbs().maxCoeff(), kRounding * straight.maxCoeff());
}

// A bar bent to a slight curvature c about z: σ_xx = E c y, linear, which 10-node cells have
// exactly at their corners too.
TEST(Stress, OfSlightBendingGrowsLinearlyAcrossTheBar) {
  const Body body = Bar(MaterialModel::kStVenantKirchhoff, 2);
  const double c = 1e-5;  // 1/m
  Eigen::Matrix3Xd u(3, body.mesh.num_nodes());
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    const Eigen::Vector3d X = body.mesh.nodes.col(node);
    u.col(node) << c * X.x() * X.y(),
        -0.5 * c * X.x() * X.x() - 0.5 * kPoisson * c * (X.y() * X.y() - X.z() * X.z()),
        -kPoisson * c * X.y() * X.z();
  }

  const auto stress = NodalStress(body, u);

  const double largest = kE * c * 0.01;  // Pa
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    // The strain of the law is quadratic: c · 20 mm of the stress.
    EXPECT_NEAR(stress(0, node), kE * c * body.mesh.nodes(1, node), 1e-5 * largest);
  }
}

TEST(VonMises, OfPureShearIsRootThreeTimesTheShear) {
  Vector6d shear = Vector6d::Zero();
  shear(3) = 2;
  EXPECT_NEAR(VonMises(shear), 2 * std::sqrt(3), 1e-12);
}

}  // namespace
}  // namespace softforce::fem
