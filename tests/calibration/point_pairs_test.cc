#include "softforce/calibration/point_pairs.h"

#include <gtest/gtest.h>

#include <random>

#include "softforce/base/input_error.h"
#include "support/stereo_rig.h"

namespace softforce::calibration {
namespace {

using Status = PairRegistration::Status;
using softforce::testing::MakeStereoRig;

const Eigen::Isometry3d kTruth = Eigen::Translation3d(-0.08, 0.07, 0.5) *
                                 Eigen::AngleAxisd(2.9, Eigen::Vector3d(1, 0.1, 0.05).normalized());

const std::vector<Eigen::Vector3d> kPlaces = {{0, 0, 0},          {0.16, 0.01, 0},
                                              {0.15, 0.13, 0.02}, {0.01, 0.12, 0.01},
                                              {0.08, 0.06, 0.05}, {0.05, 0.1, 0.03}};

std::vector<vision::PointSighting> See(const camera::Rig& rig, int places, double noise_px,
                                       std::mt19937& random) {
  std::normal_distribution<double> noise(0, noise_px);
  std::vector<vision::PointSighting> pairs;
  for (int p = 0; p < places; ++p) {
    for (int c = 0; c < 2; ++c) {
      const camera::Camera& camera = rig.cameras[c];
      const Eigen::Vector2d pixel =
          camera::Project(camera.lens, camera.T_camera_rig * (kTruth * kPlaces[p])).pixel;
      pairs.push_back({kPlaces[p], c, pixel + Eigen::Vector2d(noise(random), noise(random)), {}});
    }
  }
  return pairs;
}

double ErrorOf(const vision::RigPose& pose) {  // m, the largest at a place
  double largest = 0;
  for (const Eigen::Vector3d& p : kPlaces) {
    largest = std::max(largest, (pose.T_rig_robot * p - kTruth * p).norm());
  }
  return largest;
}

TEST(RegisterByPairs, FindsTheRig) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);

  const PairRegistration found = RegisterByPairs(rig, See(rig, 4, 0, random));

  ASSERT_EQ(found.status, Status::kOk);
  EXPECT_LT(ErrorOf(found.pose), 1e-9);  // m; exact up to rounding
  EXPECT_EQ(found.num_wrong(), 0);
}

TEST(RegisterByPairs, FindsAndNamesAWrongPair) {
  const camera::Rig rig = MakeStereoRig();
  for (int wrong = 0; wrong < 10; ++wrong) {
    std::mt19937 random(wrong);
    auto pairs = See(rig, 5, 0.5, random);
    pairs[wrong].pixel += Eigen::Vector2d(40, -25);

    const PairRegistration found = RegisterByPairs(rig, pairs);

    ASSERT_EQ(found.status, Status::kOk) << wrong;
    EXPECT_EQ(found.num_wrong(), 1) << wrong;
    EXPECT_TRUE(found.wrong[wrong]) << wrong;
    EXPECT_NEAR(found.misfit_px[wrong], 47, 5) << wrong;  // px, and its noise through the pose
    EXPECT_LT(ErrorOf(found.pose), 2e-3) << wrong;        // m; half a pixel is 0.2 mm across
  }
}

TEST(RegisterByPairs, FindsAWrongPlaceThatTwoCamerasSee) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  auto pairs = See(rig, 6, 0.3, random);
  for (int i : {4, 5}) pairs[i].p_robot.x() += 0.05;  // m; typed with a wrong digit

  const PairRegistration found = RegisterByPairs(rig, pairs);

  ASSERT_EQ(found.status, Status::kOk);
  EXPECT_TRUE(found.wrong[4] && found.wrong[5]);
  EXPECT_EQ(found.num_wrong(), 2);
}

TEST(RegisterByPairs, CannotTellWhichOfFourPairsIsWrong) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  std::vector<vision::PointSighting> pairs;
  for (const auto& pair : See(rig, 4, 0.3, random)) {
    if (pair.camera == 0) pairs.push_back(pair);
  }
  pairs[2].pixel.x() += 60;
  EXPECT_NE(RegisterByPairs(rig, pairs).status, Status::kOk);
}

TEST(RegisterByPairs, RefusesTooFewPlacesAndALine) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  EXPECT_EQ(RegisterByPairs(rig, See(rig, 3, 0, random)).status, Status::kTooFewPoints);
  EXPECT_EQ(RegisterByPairs(rig, {}).status, Status::kTooFewPoints);

  std::vector<vision::PointSighting> line;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d p(0.03 * i, 0.02 * i, 0.01);
    line.push_back({p, 0, camera::Project(rig.cameras[0].lens, kTruth * p).pixel, {}});
  }
  EXPECT_EQ(RegisterByPairs(rig, line).status, Status::kCollinear);
}

TEST(PairOptions, ChecksEveryOption) {
  PairOptions options;
  options.pixel_sd = 0;
  EXPECT_THROW(options.Check(), base::InputError);
  options = {};
  options.max_misfit = 1;
  EXPECT_THROW(options.Check(), base::InputError);
  options = {};
  options.max_trials = 0;
  EXPECT_THROW(options.Check(), base::InputError);
}

}  // namespace
}  // namespace softforce::calibration
