#include "softforce/geometry/rigid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace softforce::geometry {
namespace {

Vector6d RandomTwist(std::mt19937& random, double angle) {
  std::normal_distribution<double> normal;
  Vector6d xi;
  for (double& entry : xi) entry = normal(random);
  xi.tail<3>() *= angle / xi.tail<3>().norm();
  return xi;
}

// The power series of the matrix exponential: slow, and right by definition.
Eigen::Matrix4d ExponentialSeries(const Vector6d& xi) {
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator.topLeftCorner<3, 3>() = Skew(xi.tail<3>());
  generator.topRightCorner<3, 1>() = xi.head<3>();
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity(), sum = term;
  for (int k = 1; k < 60; ++k) {
    term = term * generator / k;
    sum += term;
  }
  return sum;
}

TEST(Skew, TimesAVectorIsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);

  EXPECT_LT((Skew(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(ExpSe3, EqualsThePowerSeries) {
  std::mt19937 random(1);
  // 1e-4 rad is where the code changes from quotients to short series.
  for (const double angle : {0.0, 1e-12, 0.99e-4, 1.01e-4, 1e-2, 1.0, M_PI, 4.0}) {
    const Vector6d xi = RandomTwist(random, angle);

    const double error = (ExpSe3(xi).matrix() - ExponentialSeries(xi)).norm();

    EXPECT_LT(error, 1e-11) << "angle " << angle << " rad";  // cancellation in (a − sin a)/a³
  }
}

TEST(ExpSe3, OfTheOppositeTwistIsTheInverse) {
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {
    const Vector6d xi = RandomTwist(random, 0.3 * i);

    const Eigen::Isometry3d product = ExpSe3(xi) * ExpSe3(-xi);

    EXPECT_LT((product.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  }
}

TEST(ExpSe3, OfAPureTranslationIsThatTranslation) {
  Vector6d xi = Vector6d::Zero();
  xi.head<3>() << 1, 2, 3;

  const Eigen::Isometry3d T = ExpSe3(xi);

  EXPECT_EQ(T.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(T.linear(), Eigen::Matrix3d::Identity());
}

TEST(ExpSe3, RotatesRigidly) {
  std::mt19937 random(3);

  const Eigen::Isometry3d T = ExpSe3(RandomTwist(random, 2.5));

  EXPECT_LT(RotationDefect(T.linear()), 1e-14);
}

TEST(RotationDefect, OfAScaledRotationIsTheExcess) {
  EXPECT_NEAR(RotationDefect(1.1 * Eigen::Matrix3d::Identity()), 0.21, 1e-12);  // 1.1² − 1
}

TEST(RotationDefect, OfAMirrorIsTwo) { EXPECT_EQ(RotationDefect(-Eigen::Matrix3d::Identity()), 2); }

}  // namespace
}  // namespace softforce::geometry
