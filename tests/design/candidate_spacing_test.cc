#include "softforce/design/candidate_spacing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "design/plate.h"

namespace softforce::design {
namespace {

// Free forces under the plate in two rows; markers on its top.
class CandidateSpacingTest : public ::testing::Test {
 protected:
  CandidateGrid Judge(int columns, double expected) {
    std::vector<PlacedLoad> candidates;
    const double spacing = 0.08 / (columns - 1);
    for (int i = 0; i < columns; ++i) {
      for (const double y : {0.015, 0.045}) {
        candidates.push_back(plate_.LoadAt({0.015 + i * spacing, y, 0}));
      }
    }
    const Eigen::MatrixXd response =
        ResponseTo(plate_.solver.get(), plate_.solver->AtRest(), plate_.points);
    return JudgeCandidates(spacing, candidates, response, plate_.sights, expected);
  }

  testing::Plate plate_;
};

TEST_F(CandidateSpacingTest, CloserCandidatesAreHarderToTellApart) {
  const CandidateGrid wide = Judge(2, 0.4), close = Judge(5, 0.4);

  EXPECT_EQ(wide.components, 12);
  EXPECT_GT(close.I_w, wide.I_w);
  EXPECT_GT(close.force_sd, wide.force_sd);
}

TEST_F(CandidateSpacingTest, TheStandardDeviationDecidesWhatIsToldApart) {
  const CandidateGrid grid = Judge(3, 1);
  EXPECT_LT(grid.force_sd, grid.worst_force_sd);

  // 3.29 standard deviations: once in a thousand.
  EXPECT_EQ(Judge(3, 3.3 * grid.worst_force_sd).told_apart, 1);
  EXPECT_LT(Judge(3, 3.2 * grid.worst_force_sd).told_apart, 1);
  EXPECT_NEAR(Judge(3, 3.3 * grid.force_sd).told_apart, 0.5, 0.1);  // one of 18 components
  EXPECT_TRUE(Judge(3, 3.3 * grid.worst_force_sd).supported());
  EXPECT_FALSE(Judge(3, 3.3 * grid.force_sd).supported());
}

TEST_F(CandidateSpacingTest, TheoremFourLimitsThem) {
  plate_.points.resize(4);
  plate_.sights.resize(4);
  EXPECT_TRUE(Judge(2, 0.4).enough_markers);  // 12 unknowns, 12 equations

  const CandidateGrid grid = Judge(3, 0.4);  // 18 unknowns

  EXPECT_FALSE(grid.enough_markers);
  EXPECT_FALSE(grid.supported());
  EXPECT_TRUE(std::isnan(grid.I_w));
}

TEST(SpacingsToJudge, BeginWhereTheoremFourEnds) {
  const std::vector<double> spacings = SpacingsToJudge(0.04, 14, 3);  // m²: 200 × 200 mm

  EXPECT_NEAR(kFilling * 0.04 / (spacings.front() * spacings.front()), 14,
              1e-9);  // candidates; rounding
  EXPECT_GE(kFilling * 0.04 / (spacings.back() * spacings.back()), 2 - 1e-9);
  EXPECT_TRUE(std::is_sorted(spacings.begin(), spacings.end()));
}

TEST(SpacingOf, IsTwiceTheRegionsLongAxis) {
  const std::vector<ExpectedError> errors(5, ExpectedError{1.2e-3, 1e-3, 0.01});

  // m; χ² of 2 degrees of freedom stays below 5.991 in 95 %.
  EXPECT_NEAR(SpacingOf(errors).median, 2 * std::sqrt(5.991) * 1e-3, 1e-6);
  EXPECT_NEAR(SpacingOf(errors).most, 2 * std::sqrt(5.991) * 1e-3, 1e-6);
}

}  // namespace
}  // namespace softforce::design
