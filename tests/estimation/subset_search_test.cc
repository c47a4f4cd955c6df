#include "estimation/subset_search.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include <algorithm>
#include <random>

namespace softforce::estimation {
namespace {

constexpr int kRows = 30;

// Groups of three unknowns with random influences, of which two act; unit noise.
class TwoOfMany : public ::testing::Test {
 protected:
  GroupedProblem Make(int groups, std::vector<int> acting, double strength) {
    std::normal_distribution<double> normal;
    GroupedProblem problem;
    problem.b = Eigen::VectorXd::NullaryExpr(kRows, [&] { return normal(random_); });
    for (int g = 0; g < groups; ++g) {
      problem.A.push_back(Eigen::MatrixXd::NullaryExpr(kRows, 3, [&] { return normal(random_); }));
      problem.push.push_back(false);
      if (std::find(acting.begin(), acting.end(), g) == acting.end()) continue;
      problem.b += problem.A.back() * Eigen::Vector3d::Constant(strength);
    }
    return problem;
  }

  std::mt19937 random_{3};
};

TEST_F(TwoOfMany, AreFoundAmongFew) {
  const SubsetSearch search(Make(10, {3, 7}, 5));

  EXPECT_EQ(search.Best(4, std::vector<double>(10, 20)).groups, (std::vector<int>{3, 7}));
}

TEST_F(TwoOfMany, AreFoundAmongTooManyToTryAll) {
  const SubsetSearch search(Make(60, {11, 47}, 5));

  EXPECT_EQ(search.Best(4, std::vector<double>(60, 25)).groups, (std::vector<int>{11, 47}));
}

TEST_F(TwoOfMany, NoneIsFoundWherePricesExceedWhatTheyExplain) {
  const SubsetSearch search(Make(10, {3, 7}, 5));

  EXPECT_TRUE(search.Best(4, std::vector<double>(10, 1e9)).groups.empty());
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
  EXPECT_EQ(search.Best(2, std::vector<double>(4, 1)).groups, std::vector<int>{0});
}

TEST_F(TwoOfMany, ThresholdKeepsTheStrong) {
  const SubsetSearch search(Make(6, {0, 5}, 20));

  EXPECT_EQ(search.Threshold(0.25).groups, (std::vector<int>{0, 5}));
}

}  // namespace
}  // namespace softforce::estimation
