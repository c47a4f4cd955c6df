#include "allocation/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace softforce::allocation {
namespace {

double CheapestByTrial(const Eigen::MatrixXd& cost) {
  std::vector<int> columns(cost.cols());
  std::iota(columns.begin(), columns.end(), 0);
  double best = std::numeric_limits<double>::infinity();
  do {
    double sum = 0;
    for (int r = 0; r < cost.rows(); ++r) sum += cost(r, columns[r]);
    best = std::min(best, sum);
  } while (std::next_permutation(columns.begin(), columns.end()));
  return best;
}

TEST(Assignment, IsTheCheapestOfAll) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> price(-5, 10);
  for (int trial = 0; trial < 200; ++trial) {
    const int rows = 1 + trial % 5;
    const int columns = rows + trial % 3;
    const Eigen::MatrixXd cost =
        Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return price(random); });

    const Assignment found = AssignRows(cost);

    EXPECT_NEAR(found.cost, CheapestByTrial(cost), 1e-12);
    std::vector<int> used = found.column_of_row;
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::unique(used.begin(), used.end()), used.end());
  }
}

}  // namespace
}  // namespace softforce::allocation
