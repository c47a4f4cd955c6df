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

TEST(Progress, KeepsControlCharactersOutOfALog) {
  const std::string log = Log(25, 30);

  EXPECT_EQ(log.find('\r'), std::string::npos);
  EXPECT_EQ(log.find('\033'), std::string::npos);
}

TEST(ProgressLine, ShowsABarTheRateAndTheTimeLeft) {
  EXPECT_EQ(ProgressLine("frames", 30, 120, 15, 8),
            "frames [==      ]: 30 of 120 (25 %), 15.0 per second, 6 s left");
  EXPECT_EQ(ProgressLine("frames", 120, 120, 15, 8),
            "frames [========]: 120 of 120 (100 %), 15.0 per second");
  EXPECT_EQ(ProgressLine("frames", 60, 60'000, 10, 0),
            "frames: 60 of 60000 (0 %), 10.0 per second, 100 min left");
}

TEST(ProgressLine, TellsTheRestOfALiveSource) {
  EXPECT_EQ(ProgressLine("frames", 30, 0, 29.97, 8, "2 dropped"),
            "frames: 30, 30.0 per second, 2 dropped");
  EXPECT_EQ(ProgressLine("frames", 0, 0, 0, 8), "frames: 0");
}

}  // namespace
}  // namespace softforce::base
