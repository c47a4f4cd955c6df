#include "pipeline/stage_clock.h"

#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

TEST(StageClock, ReportsStagesInTheOrderOfFirstUse) {
  StageClock clock;
  EXPECT_EQ(clock.Measure("decode", [] { return 7; }), 7);
  clock.Measure("estimate", [] {});
  clock.Measure("decode", [] {});

  const auto report = clock.Report();

  ASSERT_EQ(report.size(), 2u);
  EXPECT_EQ(report[0].stage, "decode");
  EXPECT_EQ(report[0].count, 2);
  EXPECT_EQ(report[1].stage, "estimate");
  EXPECT_LE(report[0].median_ms, report[0].max_ms);
}

TEST(StageClock, TellsHowManyFramesWaited) {
  StageClock clock;
  for (const int waiting : {0, 3, 0, 1}) clock.BookQueue("estimate", waiting);
  clock.Measure("decode", [] {});

  const auto report = clock.Report();

  EXPECT_TRUE(report[0].queued);
  EXPECT_EQ(report[0].queue_max, 3);
  EXPECT_DOUBLE_EQ(report[0].queue_mean, 1);
  EXPECT_FALSE(report[1].queued);
}

}  // namespace
}  // namespace softforce::pipeline
