#include "softforce/fem/compliance.h"

#include <gtest/gtest.h>

namespace softforce::fem {
namespace {

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
}  // namespace softforce::fem
