#include "softforce/validation/measures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softforce::validation {
namespace {

TEST(ForceError, IsTheSumOverAllComponents) {
  const Eigen::Vector3d computed(0.1, -0.2, 0.5), applied(0, 0.1, 0.4);
  EXPECT_NEAR(ForceError(computed, applied), 0.1 + 0.3 + 0.1, 1e-15);  // N; rounding
}

TEST(ForceError, IsNotANumberWithoutAnAnswer) {
  EXPECT_TRUE(std::isnan(ForceError(Eigen::Vector2d(NAN, 0), Eigen::Vector2d(0, 0))));
}

TEST(InverseComplianceNorm, OfOneSpringIsItsStiffness) {
  EXPECT_NEAR(InverseComplianceNorm(Eigen::MatrixXd::Constant(1, 1, 0.004)), 250, 1e-10);  // N/m
}

TEST(InverseComplianceNorm, IsTheLargestColumnSumOfThePseudoInverse) {
  // Two forces, seen by three coordinates: W⁺ = (WᵀW)⁻¹Wᵀ by hand.
  Eigen::MatrixXd W(3, 2);
  W << 1, 0,  //
      0, 2,   //
      0, 0;
  EXPECT_NEAR(InverseComplianceNorm(W), 1, 1e-12);  // N/m; columns of W⁺: (1, 0), (0, 1/2), (0, 0)

  W << 1, 1,  //
      0, 1,   //
      0, 0;
  EXPECT_NEAR(InverseComplianceNorm(W), 2, 1e-12);  // N/m; columns of W⁺: (1, 0), (−1, 1), (0, 0)
}

TEST(InverseComplianceNorm, FallsWhenThePointsAreSeenTwice) {
  Eigen::MatrixXd W(2, 1);
  W << 0.01, 0.01;
  EXPECT_NEAR(InverseComplianceNorm(W), 50, 1e-10);  // N/m; each coordinate counts half
}

}  // namespace
}  // namespace softforce::validation
