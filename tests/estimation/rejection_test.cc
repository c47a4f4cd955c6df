#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "softforce/estimation/force_estimator.h"
#include "support/bar_experiment.h"

namespace softforce::estimation {
namespace {

constexpr double kNoise = 2e-5;              // m
const Eigen::Vector2d kForce(0.005, -0.01);  // N

ForceEstimate EstimateFrom(const testing::BarExperiment& bar,
                           const std::vector<Observation>& observations) {
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  return estimator.Estimate(observations, {});
}

TEST(Rejection, AnImpossibleObservationIsNotUsed) {
  const testing::BarExperiment bar;
  std::vector<Observation> observations = bar.Observe(bar.Load(kForce), kNoise);
  observations[3].position.y() += 2e-3;  // m, a hundred standard deviations

  const ForceEstimate estimate = EstimateFrom(bar, observations);

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_EQ(estimate.rejected[3], 1);
  EXPECT_EQ(std::count(estimate.rejected.begin(), estimate.rejected.end(), 1), 1);
  EXPECT_LT((estimate.intensity - kForce).norm(), 1e-5);  // N
}

TEST(Rejection, PoisonDoesNotChangeTheAnswer) {
  const testing::BarExperiment bar;
  const std::vector<Observation> clean = bar.Observe(bar.Load(kForce), kNoise);
  const ForceEstimate reference = EstimateFrom(bar, clean);
  for (const double poison : {1e6, -1e6, double{NAN}, double{INFINITY}}) {
    std::vector<Observation> poisoned = clean;
    poisoned.push_back(clean.front());
    poisoned.back().position.setConstant(poison);

    const ForceEstimate estimate = EstimateFrom(bar, poisoned);

    ASSERT_TRUE(estimate.ok()) << poison << ": " << estimate.BriefReport();
    EXPECT_EQ(estimate.rejected.back(), 1) << poison;
    EXPECT_LT((estimate.intensity - reference.intensity).norm(), 1e-5) << poison;  // N
  }
}

TEST(Rejection, DoesNotMistakeAJumpForBadObservations) {
  // The first frame is loaded already, and the model is 2 % softer than the truth: weighed by pixel
  // noise alone, every marker would be impossible.
  testing::BarExperiment bar;
  const std::vector<Observation> observations = bar.Observe(bar.Load(2 * kForce), kNoise);
  bar.body.materials[0].youngs_modulus *= 0.98;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites);

  const ForceEstimate estimate = estimator.Estimate(observations, {});

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_EQ(std::count(estimate.rejected.begin(), estimate.rejected.end(), 1), 0);
  EXPECT_LT((estimate.intensity - 2 * kForce).norm(),
            0.05 * kForce.norm());  // N; 2 % of the force and a margin
}

TEST(Rejection, OfEverythingIsAStatus) {
  const testing::BarExperiment bar;
  std::vector<Observation> observations = bar.Observe(bar.Load(kForce), kNoise);
  for (Observation& seen : observations) seen.position.setConstant(NAN);

  const ForceEstimate estimate = EstimateFrom(bar, observations);

  EXPECT_EQ(estimate.status, ForceEstimate::Status::kTooFewObservations);
}

}  // namespace
}  // namespace softforce::estimation
