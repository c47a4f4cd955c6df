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

}  // namespace
}  // namespace softforce::pipeline
