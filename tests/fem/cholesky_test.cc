#include "fem/cholesky.h"

#include <gtest/gtest.h>

#include <ctime>
#include <random>

#include "fem/elements.h"
#include "fem/tangent.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

double ProcessorSeconds(clockid_t clock) {
  std::timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct BarTangent {
  Body body = testing::MakeBar(2, 60);
  Elements elements{body};
  TangentAssembler assembler{body, elements};

  BarTangent() {
    assembler.Assemble(elements, Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes()), {}, {});
  }
};

// Debian's CHOLMOD starts spinning OpenMP threads whatever the environment says.
TEST(Cholesky, KeepsOtherThreadsIdle) {
  const BarTangent bar;
  Cholesky cholesky(bar.assembler.matrix());
  Eigen::MatrixXd b = Eigen::MatrixXd::Ones(bar.assembler.matrix().size(), 8);
  cholesky.Factorise(bar.assembler.matrix());
  const double own = ProcessorSeconds(CLOCK_THREAD_CPUTIME_ID);
  const double all = ProcessorSeconds(CLOCK_PROCESS_CPUTIME_ID);
  while (ProcessorSeconds(CLOCK_THREAD_CPUTIME_ID) < own + 0.2) {
    ASSERT_TRUE(cholesky.Factorise(bar.assembler.matrix()));
    cholesky.SolveInPlace(&b);
  }
  const double own_used = ProcessorSeconds(CLOCK_THREAD_CPUTIME_ID) - own;
  const double all_used = ProcessorSeconds(CLOCK_PROCESS_CPUTIME_ID) - all;
  // A ratio of processor times, whatever else the machine does. OpenBLAS's idle thread may spin
  // for some hundredths of a second after it was started; two spinning threads give 2.
  EXPECT_LT(all_used / own_used, 1.4);
}

TEST(Cholesky, SolvesRoughlyWhatItSolvesExactly) {
  const BarTangent bar;
  Cholesky cholesky(bar.assembler.matrix());
  ASSERT_TRUE(cholesky.Factorise(bar.assembler.matrix()));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(bar.assembler.matrix().size(),
                                                         [&] { return 1e-9 * normal(random); });
  Eigen::MatrixXd exact = b;
  cholesky.SolveInPlace(&exact);
  // 6e-8 of single precision, times what the condition of a bar (1e7) lets through; 2e-5 seen.
  EXPECT_LT((cholesky.SolveRoughly(b) - exact).norm(), 1e-3 * exact.norm());
  EXPECT_EQ(cholesky.SolveRoughly(0 * b).norm(), 0);
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefiniteUnlessShifted) {
  BarTangent bar;
  LowerBlocks negative = bar.assembler.matrix();
  double largest = 0;
  for (double& value : negative.value) {
    value = -value;
    largest = std::max(largest, std::abs(value));
  }
  Cholesky cholesky(negative);
  EXPECT_FALSE(cholesky.Factorise(negative));
  EXPECT_TRUE(cholesky.Factorise(negative, 100 * largest));
}

}  // namespace
}  // namespace softforce::fem
