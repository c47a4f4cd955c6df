#include "softforce/calibration/register.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "support/stereo_rig.h"

namespace softforce::calibration {
namespace {

using softforce::testing::MakeStereoRig;

const Eigen::Isometry3d kTruth = Eigen::Translation3d(-0.08, 0.07, 0.5) *
                                 Eigen::AngleAxisd(2.9, Eigen::Vector3d(1, 0.1, 0.05).normalized());

// Four tags of 20 mm on one plane around the robot, ids 100 … 103.
std::vector<Fiducial> MakeFiducials() {
  std::vector<Fiducial> fiducials;
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(-0.04, 0.0), Eigen::Vector2d(0.17, 0.0),
                                    Eigen::Vector2d(0.17, 0.12), Eigen::Vector2d(-0.04, 0.12)}) {
    Fiducial fiducial;
    fiducial.id = 100 + static_cast<int>(fiducials.size());
    const Eigen::Vector3d origin(at.x(), at.y(), -0.04);
    fiducial.corners = {origin + Eigen::Vector3d(0, 0.02, 0),
                        origin + Eigen::Vector3d(0.02, 0.02, 0),
                        origin + Eigen::Vector3d(0.02, 0, 0), origin};
    fiducials.push_back(fiducial);
  }
  return fiducials;
}

// What the cameras see of the fiducials in one frame. Each tag is mounted turned by quarter turns:
// its upright top left corner is where the scene has corner `quarter_turns`.
std::vector<std::vector<vision::Tag>> See(const camera::Rig& rig,
                                          const std::vector<Fiducial>& fiducials, double sigma,
                                          std::mt19937& random, int quarter_turns = 0) {
  std::normal_distribution<double> noise(0, 1);
  std::vector<std::vector<vision::Tag>> tags(rig.cameras.size());
  for (size_t c = 0; c < rig.cameras.size(); ++c) {
    const camera::Camera& camera = rig.cameras[c];
    for (const Fiducial& fiducial : fiducials) {
      vision::Tag tag;
      tag.family = fiducial.family;
      tag.id = fiducial.id;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d p =
            camera.T_camera_rig * (kTruth * fiducial.corners[(i + quarter_turns) % 4]);
        tag.corners[i] = camera::Project(camera.lens, p).pixel +
                         sigma * Eigen::Vector2d(noise(random), noise(random));
        tag.corner_covariances[i] = sigma * sigma * Eigen::Matrix2d::Identity();
      }
      tags[c].push_back(tag);
    }
  }
  return tags;
}

// m and rad together
double ErrorOf(const vision::RigPose& pose) {
  const Eigen::Isometry3d error = kTruth * pose.T_rig_robot.inverse();
  return error.translation().norm() + Eigen::AngleAxisd(error.linear()).angle();
}

TEST(FiducialRegistration, FindsTheRig) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  FiducialRegistration registration(rig, MakeFiducials());

  registration.Add(See(rig, MakeFiducials(), 0, random));

  const vision::RigPose pose = registration.Solve();
  ASSERT_TRUE(pose.ok());
  EXPECT_LT(ErrorOf(pose), 1e-9);  // m, rad; exact up to rounding
  EXPECT_EQ(registration.num_sightings(), 8);
  EXPECT_EQ(registration.Families(), std::vector<std::string>{"tag36h11"});
}

TEST(FiducialRegistration, AveragesOverFramesDownToAFloor) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  FiducialRegistration registration(rig, MakeFiducials());
  const auto trace_after = [&](int frames) {
    for (int i = 0; i < frames; ++i) registration.Add(See(rig, MakeFiducials(), 0.3, random));
    return registration.Solve().covariance.trace();
  };

  const double after_1 = trace_after(1);
  const double after_10 = trace_after(9);
  const double after_1000 = trace_after(990);
  const double after_2000 = trace_after(1000);

  EXPECT_LT(after_10, after_1 / 5);
  // 0.3 px over √1000 is a third of the floor of 0.03 px.
  EXPECT_GT(after_1000, after_1 / 150);
  EXPECT_NEAR(after_2000 / after_1000, 1, 0.1);
}

TEST(FiducialRegistration, IgnoresTagsThatItDoesNotKnow) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  auto seen = See(rig, MakeFiducials(), 0, random);
  vision::Tag unknown = seen[0][0];
  unknown.id = 7;
  for (Eigen::Vector2d& corner : unknown.corners) corner.array() += 1e6;
  vision::Tag other_family = unknown;
  other_family.id = 100;
  other_family.family = "tag25h9";
  seen[0].push_back(unknown);
  seen[0].push_back(other_family);
  FiducialRegistration registration(rig, MakeFiducials());

  registration.Add(seen);

  EXPECT_EQ(registration.num_sightings(), 8);
  EXPECT_LT(ErrorOf(registration.Solve()), 1e-9);  // m, rad
}

TEST(FiducialRegistration, IgnoresAnIdThatIsSeenTwiceInOnePicture) {
  const camera::Rig rig = MakeStereoRig();
  const std::vector<Fiducial> fiducials = MakeFiducials();
  std::mt19937 random(1);
  auto tags = See(rig, fiducials, 0, random);
  vision::Tag stray = tags[0][1];
  for (Eigen::Vector2d& corner : stray.corners) corner.array() += 1e6;  // poison
  tags[0].push_back(stray);
  FiducialRegistration registration(rig, fiducials);

  registration.Add(tags);

  EXPECT_EQ(registration.num_sightings(), 7);
  const vision::RigPose pose = registration.Solve();
  ASSERT_EQ(pose.status, vision::RigPose::Status::kOk);
  EXPECT_LT((pose.T_rig_robot.matrix() - kTruth.matrix()).norm(), 1e-9);  // m, exact up to rounding
}

TEST(FiducialRegistration, RecognisesTagsThatAreAllTurnedAlike) {
  const camera::Rig rig = MakeStereoRig();
  for (const int turns : {1, 2, 3}) {
    std::mt19937 random(1);
    FiducialRegistration registration(rig, MakeFiducials());

    registration.Add(See(rig, MakeFiducials(), 0.05, random, turns));

    const vision::RigPose pose = registration.Solve();
    ASSERT_TRUE(pose.ok()) << turns;
    EXPECT_LT(ErrorOf(pose), 3e-3) << turns;  // m, rad; noise of 0.05 px gives 1e-3
    EXPECT_LT(pose.rms_px, 0.2) << turns;
  }
}

TEST(FiducialRegistration, SaysThatItSawNothing) {
  const camera::Rig rig = MakeStereoRig();
  FiducialRegistration registration(rig, MakeFiducials());
  registration.Add({{}, {}});
  EXPECT_EQ(registration.Solve().status, vision::RigPose::Status::kTooFewPoints);
  EXPECT_EQ(registration.num_sightings(), 0);
}

}  // namespace
}  // namespace softforce::calibration
