#include "estimation/subset_search.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include <algorithm>
#include <functional>
#include <random>

namespace softforce::estimation {
namespace {

constexpr int kRows = 30;

// Groups of three unknowns with random influences, of which two act; unit noise.
class TwoOfMany : public ::testing::Test {
 protected:
  GroupedProblem Make(int groups, const std::vector<int>& acting, double strength) {
    return Make(groups, acting, [strength] { return strength; });
  }

  GroupedProblem Make(int groups, const std::vector<int>& acting,
                      const std::function<double()>& strength) {
    std::normal_distribution<double> normal;
    GroupedProblem problem;
    problem.b = Eigen::VectorXd::NullaryExpr(kRows, [&] { return normal(random_); });
    for (int g = 0; g < groups; ++g) {
      problem.A.push_back(Eigen::MatrixXd::NullaryExpr(kRows, 3, [&] { return normal(random_); }));
      problem.push.push_back(false);
      if (std::find(acting.begin(), acting.end(), g) == acting.end()) continue;
      problem.b += problem.A.back() * Eigen::Vector3d::NullaryExpr([&] { return strength(); });
    }
    return problem;
  }

  std::mt19937 random_{3};
};

TEST_F(TwoOfMany, AreFoundAmongFew) {
  const SubsetSearch search(Make(10, {3, 7}, 5));

  EXPECT_EQ(search.Weigh(4).best.groups, (std::vector<int>{3, 7}));
}

TEST_F(TwoOfMany, AreFoundAmongTooManyToTryAll) {
  const SubsetSearch search(Make(60, {11, 47}, 5));

  EXPECT_EQ(search.Weigh(4).best.groups, (std::vector<int>{11, 47}));
}

// Probabilities are frequencies: of the answers held to be right with probability p, a share p is.
// None to three groups act, with unknowns of a size that the search does not know. Of 400 shares
// around 0.8 the standard deviation is 0.02.
TEST_F(TwoOfMany, ProbabilitiesAreKept) {
  constexpr int kDraws = 400;
  std::normal_distribution<double> unknown(0, 1);
  std::uniform_int_distribution<int> count(0, 3);
  double right = 0, said = 0;
  int sure = 0, sure_and_right = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<int> acting{1, 4, 6};
    acting.resize(count(random_));
    const SubsetOdds odds =
        SubsetSearch(Make(8, acting, [&] { return unknown(random_); })).Weigh(3);
    const bool is_right = odds.best.groups == acting;
    right += is_right / double{kDraws};
    said += odds.likely.front().probability / kDraws;
    if (odds.least_certain(8) < 0.99) continue;
    ++sure;
    sure_and_right += is_right;
  }
  EXPECT_LT(right, 0.95);  // or the draws would say little
  EXPECT_NEAR(said, right, 0.06);
  EXPECT_GT(sure, 50);
  EXPECT_GE(sure_and_right, 0.97 * sure);
}

// Of 300 frames of noise, three at most.
TEST_F(TwoOfMany, NoneIsFoundInNoise) {
  int found = 0;
  for (int draw = 0; draw < 300; ++draw) {
    found += !SubsetSearch(Make(10, {}, 0)).Weigh(3).best.groups.empty();
  }
  EXPECT_LE(found, 3);
}

TEST_F(TwoOfMany, ShadowsOfEachOtherAreEquallyLikely) {
  GroupedProblem problem = Make(5, {1}, 5);
  problem.A[4] = problem.A[1];

  const SubsetOdds odds = SubsetSearch(problem).Weigh(3);

  ASSERT_GE(odds.likely.size(), 2U);
  EXPECT_NEAR(odds.likely[0].probability, odds.likely[1].probability, 1e-9);
  EXPECT_GT(odds.likely[0].probability, 0.45);
}

TEST_F(TwoOfMany, FitIsTheLeastSquares) {
  const GroupedProblem problem = Make(5, {1, 2}, 1);

  const Subset fit = SubsetSearch(problem).Fit({1, 4});

  Eigen::MatrixXd A(kRows, 6);
  A << problem.A[1], problem.A[4];
  const Eigen::VectorXd x = A.householderQr().solve(problem.b);
  EXPECT_LT((fit.x - x).norm(), 1e-12 * x.norm());
  EXPECT_NEAR(fit.chi2, (problem.b - A * x).squaredNorm(), 1e-10);
}

TEST_F(TwoOfMany, ShadowsOfEachOtherAreNoSubset) {
  GroupedProblem problem = Make(3, {1}, 5);
  problem.A[2] = 2 * problem.A[1];

  EXPECT_TRUE(std::isinf(SubsetSearch(problem).Fit({1, 2}).chi2));
}

TEST_F(TwoOfMany, OneThatWouldPullIsLeftOut) {
  GroupedProblem problem = Make(4, {0}, 5);
  for (Eigen::MatrixXd& A : problem.A) A = A.leftCols(1).eval();
  problem.b = 5 * problem.A[0] - 5 * problem.A[1];
  problem.push.assign(4, true);
  const SubsetSearch search(problem);

  EXPECT_TRUE(std::isinf(search.Fit({1}).chi2));
  EXPECT_EQ(search.Weigh(2).best.groups, std::vector<int>{0});
}

TEST_F(TwoOfMany, ThresholdKeepsTheStrong) {
  const SubsetSearch search(Make(6, {0, 5}, 20));

  EXPECT_EQ(search.Threshold(0.25).groups, (std::vector<int>{0, 5}));
}

}  // namespace
}  // namespace softforce::estimation
