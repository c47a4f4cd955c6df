#include "softforce/estimation/force_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "softforce/base/input_error.h"
#include "support/bar_experiment.h"
#include "support/hollow_box.h"

namespace softforce::estimation {
namespace {

constexpr double kNoise = 2e-5;  // m

TEST(ForceEstimator, RecoversAForceFromExactObservations) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.01, -0.03);  // N; bends the bar by a quarter of its length
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_LT((estimate.intensity - force).norm(), 1e-5);  // N; below 1 % of its standard deviation
  EXPECT_LT(estimate.chi2, 1e-2);
}

TEST(ForceEstimator, FollowsALoadThatMoves) {
  const testing::BarExperiment bar;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  for (int step = 1; step <= 5; ++step) {
    const Eigen::Vector2d force(0.004 * step, -0.006 * step);
    const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});
    ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
    EXPECT_LT((estimate.intensity - force).norm(), 1e-5);  // N
  }
}

TEST(ForceEstimator, ReportsTheScatterThatNoiseMakes) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.005, -0.01);
  const fem::Equilibrium truth = bar.Load(force);
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  std::mt19937 random(11);
  constexpr int kTrials = 200;
  double normalised = 0;
  for (int i = 0; i < kTrials; ++i) {
    const ForceEstimate estimate = estimator.Estimate(bar.Observe(truth, kNoise, &random), {});
    ASSERT_TRUE(estimate.ok());
    const Eigen::VectorXd error = estimate.intensity - force;
    normalised += error.dot(estimate.covariance.ldlt().solve(error)) / 2 / kTrials;
  }
  EXPECT_NEAR(normalised, 1, 0.2);  // standard error 0.06; the tangent is a few per cent stale
}

TEST(ForceEstimator, UsesCablesByDisplacementAsKnownInputs) {
  testing::BarExperiment bar;
  bar.body.cables.push_back(
      {"upper", {testing::PointOf(bar.body, {0.1, 0.005, 0.01})}, {-0.02, 0.005, 0.03}});
  const fem::Actuation actuation{{{fem::CableInput::kDisplacement, 2e-3}}, {}};
  const Eigen::Vector2d force(0.004, -0.008);
  const fem::Equilibrium truth = bar.Load(force, actuation);
  ASSERT_GT(truth.tension(0), 0);
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  ASSERT_TRUE(estimator.Advance(actuation).ok());

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(truth, kNoise), actuation);

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_LT((estimate.intensity - force).norm(), 1e-5);               // N
  EXPECT_NEAR(estimator.state().tension(0), truth.tension(0), 1e-5);  // N
}

TEST(ForceEstimator, UsesPressureAsAKnownInput) {
  constexpr double kHalf = 0.02;  // m
  fem::Body body;
  body.mesh = mesh::RaiseOrder(testing::MakeHollowBox(2, kHalf));
  body.materials = {testing::Silicone()};
  body.chambers = {testing::HollowOf(body.mesh, kHalf)};
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (body.mesh.nodes(2, node) < -kHalf + 1e-9) body.fixed_nodes.push_back(node);
  }
  const std::vector<ForceSite> sites{
      {"top", testing::PointOf(body, {0.01, 0, kHalf}), Eigen::Matrix3d::Identity()}};
  const Eigen::Vector3d force(0.2, -0.1, -0.6);  // N
  fem::StaticSolver solver(body, "box");
  fem::Equilibrium truth = solver.AtRest();
  fem::LoadCase load = testing::LoadAt(body, sites[0].at, force);
  load.actuation.pressures = {15e3};  // moves the top by as much as the force does
  ASSERT_TRUE(solver.Solve(load, &truth).ok());
  std::vector<Observation> seen;
  for (const double x : {-0.015, 0.0, 0.015}) {
    for (const double y : {-0.015, 0.0, 0.015}) {
      const mesh::NodalWeights at = testing::PointOf(body, {x, y, kHalf});
      seen.push_back({at, Eigen::Vector3d::Zero(), at.Apply(body.mesh.nodes) + at.Apply(truth.u),
                      Eigen::Matrix3d::Identity() / kNoise});
    }
  }

  ForceEstimator estimator(&solver, sites, testing::ExactModel());
  const ForceEstimate estimate = estimator.Estimate(seen, load.actuation);

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_LT((estimate.intensity - force).norm(), 1e-4);  // N; the observations are exact
}

TEST(ForceEstimator, TwoEquationsFromOneCameraCountAsTwo) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.005, -0.01);
  std::vector<Observation> observations = bar.Observe(bar.Load(force), kNoise);
  for (Observation& seen : observations) {
    seen.position.x() += 0.02;  // along the ray of a camera that looks along x: not measured
    seen.whitening = seen.whitening.bottomRows(2).eval();
  }
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());

  const ForceEstimate estimate = estimator.Estimate(observations, {});

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_EQ(estimate.degrees_of_freedom, 2 * 8 - 2);
  EXPECT_LT((estimate.intensity - force).norm(), 1e-4);  // N
}

TEST(ForceEstimator, ARigidOffsetWithinItsPriorDoesNotMoveTheForce) {
  const testing::BarExperiment bar;
  const Eigen::Vector2d force(0.005, -0.01);
  std::vector<Observation> observations = bar.Observe(bar.Load(force), kNoise);
  const Eigen::Vector3d shift(0.1e-3, -0.1e-3, 0.15e-3);  // m
  for (Observation& seen : observations) seen.position += shift;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator with(&solver, bar.sites, testing::ExactModel());
  with.SetRegistrationCovariance(1e-6 * geometry::Matrix6d::Identity());  // (1 mm)², (1 mrad)²
  ForceEstimator without(&solver, bar.sites, testing::ExactModel());

  const ForceEstimate estimate = with.Estimate(observations, {});
  const ForceEstimate plain = without.Estimate(observations, {});

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  EXPECT_LT((estimate.offset.translation - shift).norm(), 0.02e-3);  // m
  const double error = (estimate.intensity - force).norm();
  EXPECT_TRUE(!plain.ok() || error < 0.2 * (plain.intensity - force).norm()) << error;
}

TEST(ForceEstimator, SaysThatTooFewWereSeen) {
  const testing::BarExperiment bar;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  EXPECT_EQ(estimator.Estimate({}, {}).status, ForceEstimate::Status::kTooFewObservations);

  // and the next good frame recovers
  const Eigen::Vector2d force(0, -0.01);
  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});
  ASSERT_TRUE(estimate.ok());
  EXPECT_LT((estimate.intensity - force).norm(), 1e-5);  // N
}

TEST(ForceEstimator, SaysThatForcesCannotBeToldApart) {
  testing::BarExperiment bar;
  bar.sites.push_back(bar.sites.front());  // two forces at one place
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  const Eigen::Vector4d force(0, -0.005, 0, -0.005);

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});

  EXPECT_EQ(estimate.status, ForceEstimate::Status::kUnobservable) << estimate.BriefReport();
  EXPECT_NE(estimate.reason.find("candidate tip, candidate tip"), std::string::npos)
      << estimate.reason;
}

TEST(ForceEstimator, ALargeMotionWithForcesAlongTheStiffAxisTakesFewFactorisations) {
  testing::BarExperiment bar;
  bar.sites[0].directions = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d force(0, 0.02, -0.03);  // N; bends the bar by a quarter of its length
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});

  ASSERT_TRUE(estimate.ok()) << estimate.BriefReport();
  const Eigen::VectorXd error = estimate.intensity - force;
  // Squared standard deviations, of observations that are exact.
  EXPECT_LT(error.dot(estimate.covariance.ldlt().solve(error)), 0.1);
  // Of 100 allowed. Steps that follow the linear answer push until the bar buckles, and use up all.
  EXPECT_LE(estimate.factorisations, 60);
}

TEST(ForceEstimator, GivesUpAFrameAfterABoundedNumberOfFactorisations) {
  testing::BarExperiment bar;
  fem::StaticSolver solver(bar.body, "bar");
  EstimatorOptions options = testing::ExactModel();
  options.max_factorisations = 1;
  ForceEstimator estimator(&solver, bar.sites, options);
  const Eigen::Vector2d force(0.02, -0.04);

  const ForceEstimate estimate = estimator.Estimate(bar.Observe(bar.Load(force), kNoise), {});

  EXPECT_EQ(estimate.status, ForceEstimate::Status::kNotConverged);
  EXPECT_TRUE(estimator.state().u.isZero(0)) << "the state must stay as it was";
}

TEST(ForceEstimator, AFrameEstimatedAgainCountsOnce) {
  const testing::BarExperiment bar;
  fem::StaticSolver solver(bar.body, "bar");
  EstimatorOptions options = testing::ExactModel();
  options.force_walk = 1e-6;  // N: the last frame says as much as this one
  ForceEstimator estimator(&solver, bar.sites, options);
  const auto seen = bar.Observe(bar.Load(Eigen::Vector2d(0.002, -0.003)), kNoise);
  ASSERT_TRUE(estimator.Estimate(seen, {}).ok());
  const ForceEstimate once = estimator.Estimate(seen, {});
  ASSERT_TRUE(once.ok());

  const ForceEstimate again = estimator.EstimateAgain(seen, {});

  ASSERT_TRUE(again.ok());
  // Counted twice its variance would be smaller by a third; the tangent may be a little stale.
  EXPECT_NEAR(again.covariance.trace() / once.covariance.trace(), 1, 0.02);
}

TEST(ForceEstimator, RecallsWhatItRemembered) {
  const testing::BarExperiment bar;
  fem::StaticSolver solver(bar.body, "bar");
  ForceEstimator estimator(&solver, bar.sites, testing::ExactModel());
  const ForceEstimator::Memory before = estimator.Remember();
  ASSERT_TRUE(
      estimator.Estimate(bar.Observe(bar.Load(Eigen::Vector2d(0.002, 0.003)), kNoise), {}).ok());
  ASSERT_GT(estimator.state().u.norm(), 0);

  estimator.Recall(before);

  EXPECT_TRUE(estimator.state().u.isZero(0));
  EXPECT_TRUE(estimator.intensity().isZero(0));
}

TEST(ForceEstimator, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    EstimatorOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](EstimatorOptions& o) { o.common_model_error = -1; });
  refuses([](EstimatorOptions& o) { o.local_model_error = NAN; });
  refuses([](EstimatorOptions& o) { o.loss_scale = 0; });
  refuses([](EstimatorOptions& o) { o.force_walk = 0; });
  refuses([](EstimatorOptions& o) { o.rejection_probability = 0; });
  refuses([](EstimatorOptions& o) { o.max_rejected_share = 1; });
  refuses([](EstimatorOptions& o) { o.min_singular_ratio = 0; });
  refuses([](EstimatorOptions& o) { o.max_iterations = 0; });
  refuses([](EstimatorOptions& o) { o.max_factorisations = 0; });
  refuses([](EstimatorOptions& o) { o.tolerance = 0; });
  refuses([](EstimatorOptions& o) { o.max_staleness = -1; });
}

}  // namespace
}  // namespace softforce::estimation
