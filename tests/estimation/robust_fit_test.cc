#include "estimation/robust_fit.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

namespace softforce::estimation {
namespace {

constexpr double kFar = 1e9;  // a loss scale beyond every residual: plain least squares

Bounds NoBounds(int n) {
  return {Eigen::VectorXd::Constant(n, -INFINITY), Eigen::VectorXd::Constant(n, INFINITY)};
}

// Correlated columns of very different sizes, like newtons beside radians.
std::vector<ResidualBlock> RandomBlocks(int blocks, int n, std::mt19937* random) {
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(*random); };
  std::vector<ResidualBlock> made;
  for (int b = 0; b < blocks; ++b) {
    Eigen::MatrixXd J = Eigen::MatrixXd::NullaryExpr(3, n, draw);
    J.col(1) += 0.9 * J.col(0);
    J.col(n - 1) *= 1e5;
    made.push_back({Eigen::VectorXd::NullaryExpr(3, draw), J});
  }
  return made;
}

Eigen::VectorXd Gradient(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& change) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(change.size());
  for (const ResidualBlock& b : blocks) gradient += b.J.transpose() * (b.residual + b.J * change);
  return gradient;
}

TEST(FitRobustly, WithoutOutliersOrBoundsIsLeastSquares) {
  std::mt19937 random(3);
  const std::vector<ResidualBlock> blocks = RandomBlocks(6, 5, &random);
  Eigen::MatrixXd J(18, 5);
  Eigen::VectorXd r(18);
  for (int b = 0; b < 6; ++b) {
    J.middleRows<3>(3 * b) = blocks[b].J;
    r.segment<3>(3 * b) = blocks[b].residual;
  }
  const Eigen::VectorXd expected = J.colPivHouseholderQr().solve(-r);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(5);

  const RobustFit fit = FitRobustly(blocks, zero, zero, NoBounds(5), kFar);

  ASSERT_TRUE(fit.ok);
  EXPECT_LT((J * (fit.parameters - expected)).norm(), 1e-9);  // standard deviations; rounding
  EXPECT_NEAR(fit.cost, 0.5 * (J * expected + r).squaredNorm(), 1e-9);
}

TEST(FitRobustly, WithBoundsMeetsTheOptimalityConditions) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<ResidualBlock> blocks = RandomBlocks(6, 5, &random);
    Bounds bounds = NoBounds(5);
    bounds.lower.head<4>().setZero();
    bounds.upper(3) = 0.05;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(5);

    const RobustFit fit = FitRobustly(blocks, zero, zero, bounds, kFar);

    ASSERT_TRUE(fit.ok);
    const Eigen::VectorXd gradient = Gradient(blocks, fit.parameters);
    for (int i = 0; i < 5; ++i) {
      const double tolerance = 1e-7 * (i == 4 ? 1e5 : 1);  // the columns' own sizes
      EXPECT_GE(fit.parameters(i), bounds.lower(i));
      EXPECT_LE(fit.parameters(i), bounds.upper(i));
      if (fit.parameters(i) == bounds.lower(i)) {
        EXPECT_GE(gradient(i), -tolerance);
      } else if (fit.parameters(i) == bounds.upper(i)) {
        EXPECT_LE(gradient(i), tolerance);
      } else {
        EXPECT_NEAR(gradient(i), 0, tolerance);
      }
    }
  }
}

TEST(FitRobustly, AnOutlierPullsWithTheForceOfTheLossScaleOnly) {
  // Ten measurements of zero and one of 1000: the mean is 91, Huber's estimate loss_scale / 10.
  std::vector<ResidualBlock> blocks(10, {Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Ones(1, 1)});
  blocks.push_back({Eigen::VectorXd::Constant(1, -1000), Eigen::MatrixXd::Ones(1, 1)});
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);

  const RobustFit fit = FitRobustly(blocks, zero, zero, NoBounds(1), 2);

  ASSERT_TRUE(fit.ok);
  EXPECT_NEAR(fit.parameters(0), 0.2, 1e-6);
}

TEST(FitRobustly, StaysWhereBothBoundsMeet) {
  std::mt19937 random(7);
  const std::vector<ResidualBlock> blocks = RandomBlocks(4, 3, &random);
  Bounds bounds = NoBounds(3);
  bounds.lower(0) = bounds.upper(0) = 0.3;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(3);
  start(0) = 0.3;

  const RobustFit fit = FitRobustly(blocks, Eigen::VectorXd::Zero(3), start, bounds, kFar);

  ASSERT_TRUE(fit.ok);
  EXPECT_EQ(fit.parameters(0), 0.3);
  EXPECT_EQ(fit.at_bound[0], 1);
}

}  // namespace
}  // namespace softforce::estimation
