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

}  // namespace
}  // namespace softforce::validation
