#include "softforce/base/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace softforce::base {
namespace {

using testing::HasSubstr;

// What a Progress writes where standard error is a file, after `done` of `total`, one by one.
std::string Log(int done, int total) {
  testing::internal::CaptureStderr();
  Progress progress("frames", total);
  for (int i = 1; i <= done; ++i) progress.Update(i);
  progress.Finish();
  progress.Finish();
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, WritesALineAtEveryTenthToALog) {
  const std::string log = Log(1000, 1000);

  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 11);  // 0 % … 100 %
  EXPECT_THAT(log, HasSubstr("frames: 1000 of 1000 (100 %)"));
}

TEST(Progress, SaysHowFarItCameIfItEndsEarly) {
  EXPECT_THAT(Log(7, 1000), HasSubstr("frames: 7 of 1000 (0 %)"));
}

TEST(Progress, CountsWithoutAnEndInSight) {
  const std::string log = Log(7, 0);

  EXPECT_THAT(log, HasSubstr("frames: 7, "));
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1);
}

}  // namespace
}  // namespace softforce::base
