#include "softforce/base/version.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softforce::base {
namespace {

TEST(Version, IsThreeNumbers) {
  EXPECT_THAT(kVersion, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

}  // namespace
}  // namespace softforce::base
