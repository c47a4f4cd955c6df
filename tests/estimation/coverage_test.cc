// A smaller version of benchmarks/accuracy/force_coverage.
#include <gtest/gtest.h>

#include "support/coverage_experiment.h"

namespace softforce::testing {
namespace {

class Coverage : public ::testing::TestWithParam<CoverageCase> {};

TEST_P(Coverage, OfThe95PercentIntervalsIsWhatTheySay) {
  std::mt19937 random(21);
  CoverageExperiment experiment(GetParam().uncertain);

  // Each trial with an uncertain tension needs an equilibrium of the truth.
  const int trials = GetParam().uncertain.tension > 0 ? 40 : 150;

  const CoverageExperiment::Tally tally = experiment.Run(trials, trials / 5, &random);

  EXPECT_EQ(tally.lost, 0);
  // Three intervals of a trial, correlated: the standard error is between that of independent ones
  // and √3 times it.
  const double standard_error = 100 * std::sqrt(0.95 * 0.05 / trials);
  EXPECT_NEAR(100.0 * tally.covered / tally.intervals, 95, 3 * standard_error);
}

INSTANTIATE_TEST_SUITE_P(Every, Coverage, ::testing::ValuesIn(CoverageCases()),
                         [](const auto& which) { return "case" + std::to_string(which.index); });

}  // namespace
}  // namespace softforce::testing
