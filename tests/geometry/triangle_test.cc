#include "softforce/geometry/triangle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>

namespace softforce::geometry {
namespace {

Eigen::Vector3d RandomPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {uniform(random), uniform(random), uniform(random)};
}

// The least distance from p over a fine grid of the triangle's points.
double SampledDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& p) {
  constexpr int kSteps = 200;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const Eigen::Vector3d q = a + (b - a) * i / kSteps + (c - a) * j / kSteps;
      least = std::min(least, (p - q).norm());
    }
  }
  return least;
}

void ExpectConsistent(const ClosestOnTriangle& closest, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& p) {
  const Eigen::Vector3d& w = closest.barycentric;
  EXPECT_GE(w.minCoeff(), 0);
  EXPECT_LE(w.maxCoeff(), 1);
  EXPECT_NEAR(w.sum(), 1, 1e-14);
  EXPECT_LT((w(0) * a + w(1) * b + w(2) * c - closest.point).norm(), 1e-14);
  EXPECT_NEAR((p - closest.point).norm(), closest.distance, 1e-14);
}

TEST(ClosestPointOnTriangle, IsAsCloseAsTheBestOfAFineGrid) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const auto a = RandomPoint(random), b = RandomPoint(random), c = RandomPoint(random);
    const Eigen::Vector3d p = 2 * RandomPoint(random);

    const ClosestOnTriangle closest = ClosestPointOnTriangle(a, b, c, p);

    ExpectConsistent(closest, a, b, c, p);
    const double sampled = SampledDistance(a, b, c, p);
    EXPECT_LE(closest.distance, sampled + 1e-14);
    EXPECT_GE(closest.distance, sampled - 0.02);  // edges are shorter than 4: 200 steps of 0.02
  }
}

TEST(ClosestPointOnTriangle, OfAPointInItIsThePoint) {
  const Eigen::Vector3d a(0, 0, 1), b(2, 0, 1), c(0, 3, 1), p(0.5, 0.6, 1);

  const ClosestOnTriangle closest = ClosestPointOnTriangle(a, b, c, p);

  EXPECT_LT((closest.point - p).norm(), 1e-15);
  EXPECT_LT((closest.barycentric - Eigen::Vector3d(0.55, 0.25, 0.2)).norm(), 1e-15);
}

TEST(ClosestPointOnTriangle, AboveTheFaceIsTheFootOfThePerpendicular) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);

  const ClosestOnTriangle closest = ClosestPointOnTriangle(a, b, c, {0.2, 0.3, -0.7});

  EXPECT_LT((closest.point - Eigen::Vector3d(0.2, 0.3, 0)).norm(), 1e-15);
  EXPECT_NEAR(closest.distance, 0.7, 1e-15);
}

TEST(ClosestPointOnTriangle, BeyondACornerIsTheCorner) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);

  EXPECT_EQ(ClosestPointOnTriangle(a, b, c, {3, -1, 1}).point, b);
}

TEST(ClosestPointOnTriangle, DoesNotDependOnTheOrderOfTheCorners) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const auto a = RandomPoint(random), b = RandomPoint(random), c = RandomPoint(random);
    const Eigen::Vector3d p = 2 * RandomPoint(random);

    const Eigen::Vector3d one = ClosestPointOnTriangle(a, b, c, p).point;
    const Eigen::Vector3d other = ClosestPointOnTriangle(c, a, b, p).point;
    const Eigen::Vector3d mirrored = ClosestPointOnTriangle(b, a, c, p).point;

    EXPECT_LT((one - other).norm(), 1e-10);  // slivers lose digits
    EXPECT_LT((one - mirrored).norm(), 1e-10);
  }
}

TEST(ClosestPointOnTriangle, OfThreeCornersInALineIsThatOfTheSegment) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(3, 0, 0), p(2, 1, 0);

  const ClosestOnTriangle closest = ClosestPointOnTriangle(a, b, c, p);

  ExpectConsistent(closest, a, b, c, p);
  EXPECT_LT((closest.point - Eigen::Vector3d(2, 0, 0)).norm(), 1e-15);
}

TEST(ClosestPointOnTriangle, OfThreeEqualCornersIsThatCorner) {
  const Eigen::Vector3d a(1, 2, 3), p(1, 2, 5);

  const ClosestOnTriangle closest = ClosestPointOnTriangle(a, a, a, p);

  ExpectConsistent(closest, a, a, a, p);
  EXPECT_EQ(closest.distance, 2);
}

}  // namespace
}  // namespace softforce::geometry
