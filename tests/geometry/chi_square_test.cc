#include "softforce/geometry/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softforce::geometry {
namespace {

TEST(ChiSquareQuantile, OfOneDegreeIsTheSquareOfTheNormalQuantile) {
  EXPECT_NEAR(ChiSquareQuantile(0.95, 1), 1.959963984540054 * 1.959963984540054, 1e-9);
}

TEST(ChiSquareQuantile, OfTwoDegreesIsThatOfTheExponentialDistribution) {
  for (const double probability : {0.01, 0.5, 0.95, 0.999}) {
    EXPECT_NEAR(ChiSquareQuantile(probability, 2), -2 * std::log1p(-probability), 1e-9);
  }
}

TEST(ChiSquareQuantile, GrowsWithTheProbability) {
  for (int degrees = 1; degrees < 50; degrees += 7) {
    EXPECT_LT(ChiSquareQuantile(0.9, degrees), ChiSquareQuantile(0.91, degrees));
  }
}

}  // namespace
}  // namespace softforce::geometry
