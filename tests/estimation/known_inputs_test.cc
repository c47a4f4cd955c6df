// What is known beforehand besides the observations: bounds, actuators, the last frame.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "softforce/estimation/force_estimator.h"
#include "support/bar_experiment.h"

namespace softforce::estimation {
namespace {

constexpr double kNoise = 2e-5;  // m
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A bar with a cable along its upper side.
testing::BarExperiment BarWithCable() {
  testing::BarExperiment bar;
  bar.body.cables.push_back(
      {"upper", {testing::PointOf(bar.body, {0.06, 0.005, 0.01})}, {-0.02, 0.005, 0.03}});
  return bar;
}

fem::Actuation Tension(double newtons) { return {{{fem::CableInput::kTension, newtons}}, {}}; }
fem::Actuation Shortening(double metres) {
  return {{{fem::CableInput::kDisplacement, metres}}, {}};
}

TEST(Bounds, KeepAPushFromPulling) {
  testing::BarExperiment bar;
  bar.sites[0].directions = -Eigen::Vector3d::UnitZ();
  bar.sites[0].lowest = 0;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  const auto seen = [&](double force) {
    return bar.Observe(bar.Load(Eigen::VectorXd::Constant(1, force)), kNoise);
  };

  const ForceEstimate push = estimator.Estimate(seen(0.008), {});
  ASSERT_TRUE(push.ok()) << push.BriefReport();
  EXPECT_NEAR(push.intensity(0), 0.008, 1e-5);  // N

  // Half a standard deviation of pull is noise, and is answered by no force at all.
  const double pull = -0.5 * std::sqrt(push.covariance(0, 0));
  const ForceEstimate none = estimator.Estimate(seen(pull), {});
  ASSERT_TRUE(none.ok()) << none.BriefReport();
  EXPECT_EQ(none.intensity(0), 0);
}

TEST(Bounds, ThatExcludeEachOtherAreAStatusOfThatFrame) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.005, -0.01);
  const std::vector<Observation> seen = bar.Observe(bar.Load(force), kNoise);
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  ASSERT_TRUE(estimator.Estimate(seen, {}).ok());

  estimator.SetBounds(0, 1, -1);
  const ForceEstimate refused = estimator.Estimate(seen, {});
  EXPECT_EQ(refused.status, ForceEstimate::Status::kInvalidInput);
  EXPECT_NE(refused.reason.find("candidate tip"), std::string::npos) << refused.reason;

  estimator.SetBounds(0, -kInfinity, kInfinity);
  const ForceEstimate next = estimator.Estimate(seen, {});
  ASSERT_TRUE(next.ok()) << next.BriefReport();
  EXPECT_LT((next.intensity - force).norm(), 1e-5);  // N
}

TEST(Actuation, ThatNoCableCanFollowIsAStatusOfThatFrame) {
  const testing::BarExperiment bar = BarWithCable();
  const Eigen::Vector2d force(0.004, -0.008);
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  const std::vector<Observation> seen = bar.Observe(bar.Load(force, Tension(0.1)), kNoise);
  for (const double tension : {-0.1, double{NAN}, kInfinity}) {
    const ForceEstimate refused = estimator.Estimate(seen, Tension(tension));
    EXPECT_EQ(refused.status, ForceEstimate::Status::kInvalidInput) << tension;
    EXPECT_NE(refused.reason.find("upper"), std::string::npos) << refused.reason;
  }
  const ForceEstimate next = estimator.Estimate(seen, Tension(0.1));
  ASSERT_TRUE(next.ok()) << next.BriefReport();
  EXPECT_LT((next.intensity - force).norm(), 1e-5);  // N
}

// Remark 3: told 0.05 N and 1 mm, the cable really pulls with 0.1 N, or is shortened by 2 mm.
TEST(Actuation, ThatIsUnknownIsFoundWithTheForces) {
  const testing::BarExperiment bar = BarWithCable();
  const Eigen::Vector2d force(0.004, -0.008);
  struct Case {
    fem::Actuation told, real;
    double change, tolerance;
  };
  for (const Case& c : {Case{Tension(0.05), Tension(0.1), 0.05, 1e-4},            // N
                        Case{Shortening(1e-3), Shortening(2e-3), 1e-3, 2e-6}}) {  // m
    const fem::Equilibrium truth = bar.Load(force, c.real);
    ASSERT_GT(truth.tension(0), 0);
    fem::StaticSolver solver(bar.body, "bar");
    ForceEstimator estimator(&solver, bar.sites, testing::ExactModel(), {kInfinity});

    const ForceEstimate estimate = estimator.Estimate(bar.Observe(truth, kNoise), c.told);

    ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
    EXPECT_LT((estimate.intensity - force).norm(), 1e-4);  // N; exact observations
    EXPECT_NEAR(estimate.actuator_change(0), c.change, c.tolerance);
    EXPECT_GT(estimate.actuator_sd(0), 0);
    EXPECT_NEAR(estimator.state().tension(0), truth.tension(0), 1e-3);  // N
  }
}

TEST(Actuation, ThatIsKnownSomewhatIsCorrectedByWhatIsSeen) {
  const testing::BarExperiment bar = BarWithCable();
  const Eigen::Vector2d force(0.004, -0.008);
  const std::vector<Observation> seen = bar.Observe(bar.Load(force, Tension(0.1)), kNoise);
  const auto error = [&](double uncertainty) {
    fem::StaticSolver solver(bar.body, "bar");
    ForceEstimator estimator(&solver, bar.sites, testing::ExactModel(), {uncertainty});
    const ForceEstimate estimate = estimator.Estimate(seen, Tension(0.08));
    return estimate.ok() ? (estimate.intensity - force).norm() : kInfinity;
  };
  EXPECT_LT(error(0.02), 0.2 * error(1e-6));
}

TEST(Actuation, AndForceThatLookAlikeAreNamed) {
  testing::BarExperiment bar = BarWithCable();
  // A force along the very pull of the cable, at the same place.
  const mesh::NodalWeights at = bar.body.cables[0].points[0];
  const Eigen::Vector3d place = at.Apply(bar.body.mesh.nodes);
  bar.sites = {{"beside", at, (bar.body.cables[0].guide - place).normalized()}};
  fem::StaticSolver solver(bar.body, "bar");
  EstimatorOptions options = testing::ExactModel();
  options.min_singular_ratio = 1e-4;
  ForceEstimator estimator(&solver, bar.sites, options, {kInfinity});

  const ForceEstimate estimate =
      estimator.Estimate(bar.Observe(solver.AtRest(), kNoise), Tension(0));

  EXPECT_EQ(estimate.status, ForceEstimate::Status::kUnobservable) << estimate.BriefReport();
  EXPECT_NE(estimate.reason.find("candidate beside"), std::string::npos) << estimate.reason;
  EXPECT_NE(estimate.reason.find("actuator upper"), std::string::npos) << estimate.reason;
}

TEST(TooFewObservations, NameTheForcesThatTheyLeaveOpen) {
  testing::BarExperiment bar;
  bar.sites.push_back({"middle", testing::PointOf(bar.body, {0.05, 0.005, 0.01}),
                       Eigen::Matrix3d::Identity().rightCols(2)});
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  std::vector<Observation> seen = bar.Observe(bar.Load(Eigen::Vector4d::Zero()), kNoise);
  seen.resize(1);

  const ForceEstimate estimate = estimator.Estimate(seen, {});

  EXPECT_EQ(estimate.status, ForceEstimate::Status::kTooFewObservations);
  EXPECT_NE(estimate.reason.find("tip"), std::string::npos) << estimate.reason;
  EXPECT_NE(estimate.reason.find("middle"), std::string::npos) << estimate.reason;
}

TEST(ForceWalk, SmoothsTheNoiseOfAForceThatHolds) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.005, -0.01);
  const fem::Equilibrium truth = bar.Load(force);
  const auto scatter = [&](double walk) {
    EstimatorOptions options = testing::ExactModel();
    options.force_walk = walk;
    fem::StaticSolver solver(bar.body, "bar");
    ForceEstimator estimator(&solver, bar.sites, options);
    std::mt19937 random(13);
    double sum = 0;
    for (int frame = 0; frame < 60; ++frame) {
      const ForceEstimate e = estimator.Estimate(bar.Observe(truth, kNoise, &random), {});
      EXPECT_TRUE(e.ok()) << e.BriefReport();
      if (frame >= 20) sum += (e.intensity - force).squaredNorm();
    }
    return std::sqrt(sum / 40);
  };
  const double alone = scatter(kInfinity);
  EXPECT_LT(scatter(0.1 * alone), 0.5 * alone);
}

TEST(ForceWalk, LetsAJumpThroughAfterLostFrames) {
  const testing::BarExperiment bar;
  EstimatorOptions options = testing::ExactModel();
  options.force_walk = 2e-3;  // N per frame
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, options);
  ASSERT_TRUE(estimator.Estimate(bar.Observe(bar.Load(Eigen::Vector2d::Zero()), kNoise), {}).ok());
  for (int lost = 0; lost < 20; ++lost) EXPECT_FALSE(estimator.Estimate({}, {}).ok());
  const Eigen::Vector2d force(0.005, -0.01);

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_LT((estimate.intensity - force).norm(), 2e-4);  // N; the prior holds back a little
}

}  // namespace
}  // namespace softforce::estimation
