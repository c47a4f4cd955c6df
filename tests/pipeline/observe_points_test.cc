#include "softforce/pipeline/observe_points.h"

#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

using Status = FeatureObservation::Status;

constexpr double kThreshold = 0.02;  // m

// Features 30 mm apart along x, of the markers 0, 1 and 2, known to 1 mm.
struct Row {
  std::vector<PredictedFeature> predicted;
  std::vector<int> markers{0, 1, 2};
  Eigen::Isometry3d T_rig_robot = Eigen::Isometry3d::Identity();

  Row() {
    for (const int marker : markers) {
      predicted.push_back({Eigen::Vector3d(0.03 * marker, 0, 0), 1e-6 * Eigen::Matrix3d::Identity(),
                           Eigen::Vector3d::UnitZ(), 0});
    }
  }

  std::vector<FeatureObservation> Observe(const std::vector<scene::MeasuredPoint>& points) const {
    return ObservePoints(T_rig_robot, predicted, markers, points, kThreshold, {});
  }
};

TEST(ObservePoints, BringsPointsIntoTheRobotFrame) {
  Row row;
  row.T_rig_robot = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  row.T_rig_robot.translation() = Eigen::Vector3d(1, 2, 3);
  const Eigen::Vector3d p_robot(0.031, 0.001, 0);

  const auto observations = row.Observe({{row.T_rig_robot * p_robot, 1e-4, -1}});

  ASSERT_EQ(observations[1].status, Status::kSeen);
  EXPECT_LT((observations[1].position - p_robot).norm(), 1e-12);  // m; rounding
  EXPECT_TRUE(observations[1].covariance.isApprox(1e-8 * Eigen::Matrix3d::Identity()));
  EXPECT_TRUE(observations[1].whitening.isApprox(1e4 * Eigen::Matrix3d::Identity()));
  EXPECT_EQ(observations[0].status, Status::kHidden);
}

TEST(ObservePoints, BelievesALabelWhereverThePointIs) {
  const auto observations = Row().Observe({{Eigen::Vector3d(0.5, 0, 0), 1e-4, 2}});

  ASSERT_EQ(observations[2].status, Status::kSeen);
  EXPECT_EQ(observations[2].position, Eigen::Vector3d(0.5, 0, 0));
}

TEST(ObservePoints, GivesPointsWithoutLabelsOnlyToMarkersThatHaveNone) {
  const auto observations = Row().Observe(
      {{Eigen::Vector3d(0, 0.002, 0), 1e-4, 0}, {Eigen::Vector3d(0, 0, 0), 1e-4, -1}});

  EXPECT_EQ(observations[0].position, Eigen::Vector3d(0, 0.002, 0));
  EXPECT_EQ(observations[1].status, Status::kHidden);
}

TEST(ObservePoints, CountsNothingAsExact) {
  EXPECT_TRUE(Row().Observe({{Eigen::Vector3d(0, 0, 0), 0, 0}})[0].whitening.allFinite());
}

}  // namespace
}  // namespace softforce::pipeline
