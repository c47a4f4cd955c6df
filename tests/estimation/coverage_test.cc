// A smaller version of benchmarks/accuracy/force_coverage.
#include <gtest/gtest.h>

#include "support/coverage_experiment.h"

namespace softforce::testing {
namespace {

class Coverage : public ::testing::TestWithParam<CoverageCase> {};

TEST_P(Coverage, OfThe95PercentIntervalsIsWhatTheySay) {
  std::mt19937 random(21);
  CoverageExperiment experiment(GetParam().uncertain);

  const CoverageExperiment::Tally tally = experiment.Run(150, 30, &random);

  EXPECT_EQ(tally.lost, 0);
  // 450 intervals, three of a trial correlated: a standard error of 1 to 1.8 %.
  EXPECT_NEAR(100.0 * tally.covered / tally.intervals, 95, 4);
}

INSTANTIATE_TEST_SUITE_P(Every, Coverage, ::testing::ValuesIn(CoverageCases()),
                         [](const auto& which) { return "case" + std::to_string(which.index); });

}  // namespace
}  // namespace softforce::testing
