// The paper's estimator: one linear step per frame.
#include <gtest/gtest.h>

#include "support/bar_experiment.h"

namespace softforce::estimation {
namespace {

constexpr double kNoise = 2e-5;  // m

EstimatorOptions Linear() {
  EstimatorOptions options;
  options.method = EstimationMethod::kLinearStep;
  return options;
}

TEST(LinearStep, LagsWhereTheConvergedEstimateIsRight) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.01, -0.03);  // N; bends the bar by a quarter of its length
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, Linear());
  ForceEstimate estimate;
  const auto see = [&](double share) {
    estimate = estimator.Estimate(bar.Observe(bar.Load(share * force), kNoise), {});
    ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  };

  constexpr int kRamp = 10;  // frames
  for (int frame = 1; frame <= kRamp; ++frame) see(static_cast<double>(frame) / kRamp);
  // The bar turns where a step only stretches it.
  EXPECT_GT((estimate.intensity - force).norm(), 1e-3 * force.norm());

  // Frame by frame it settles on the same answer.
  for (int frame = 0; frame < 15; ++frame) see(1);
  EXPECT_LT((estimate.intensity - force).norm(), 1e-6);  // N
}

TEST(LinearStep, BeginsAgainAfterAJumpThatItCannotFollow) {
  const testing::BarExperiment bar;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, Linear());
  const Eigen::Vector2d jump(0.02, -0.06), small(1e-6, -2e-6);  // N
  for (int frame = 0; frame < 3; ++frame)
    estimator.Estimate(bar.Observe(bar.Load(jump), kNoise), {});

  ForceEstimate estimate;
  for (int frame = 0; frame < 15; ++frame) {
    estimate = estimator.Estimate(bar.Observe(bar.Load(small), kNoise), {});
  }

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_LT((estimate.intensity - small).norm(), 1e-3 * small.norm());  // single-precision solves
}

TEST(LinearStep, IsExactForTheSmallestLoads) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(1e-6, -2e-6);  // N
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, Linear());

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});

  ASSERT_TRUE(estimate.ok());
  EXPECT_LT((estimate.intensity - force).norm(), 1e-4 * force.norm());  // single-precision solves
}

TEST(LinearStep, TakesTheActuationAsEquality) {
  testing::BarExperiment bar;
  bar.body.cables.push_back(
      {"upper", {testing::PointOf(bar.body, {0.1, 0.005, 0.01})}, {-0.02, 0.005, 0.03}});
  const Eigen::Vector2d force(0.004, -0.008);
  for (const fem::CableCommand command :
       {fem::CableCommand{fem::CableInput::kTension, 0.05},
        fem::CableCommand{fem::CableInput::kDisplacement, 2e-3}}) {
    const fem::Actuation actuation{{command}, {}};
    const fem::Equilibrium truth = bar.Load(force, actuation);
    fem::StaticSolver solver(bar.body, "bar");
    ForceEstimator estimator(&solver, bar.sites, Linear());
    ForceEstimate estimate;
    for (int frame = 0; frame < 15; ++frame) {
      estimate = estimator.Estimate(bar.Observe(truth, kNoise), actuation);
      ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
    }
    EXPECT_LT((estimate.intensity - force).norm(), 1e-6);               // N
    EXPECT_NEAR(estimator.state().tension(0), truth.tension(0), 1e-6);  // N
  }
}

TEST(LinearStep, IgnoresWhatItCannotUse) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(1e-6, -2e-6);
  std::vector<Observation> seen = bar.Observe(bar.Load(force), kNoise);
  seen[2].position.setConstant(NAN);
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, Linear());
  EXPECT_EQ(estimator.Estimate({}, {}).status, ForceEstimate::Status::kTooFewObservations);

  const ForceEstimate estimate = estimator.Estimate(seen, {});

  ASSERT_TRUE(estimate.ok());
  EXPECT_EQ(estimate.rejected[2], 1);
  EXPECT_LT((estimate.intensity - force).norm(), 1e-4 * force.norm());
}

}  // namespace
}  // namespace softforce::estimation
