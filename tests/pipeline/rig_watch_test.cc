#include "pipeline/rig_watch.h"

#include <gtest/gtest.h>

#include <random>

#include "support/stereo_rig.h"

namespace softforce::pipeline {
namespace {

using Kind = RigEvent::Kind;
using Tags = std::vector<std::vector<vision::Tag>>;

const Eigen::Isometry3d kBefore =
    Eigen::Translation3d(-0.08, 0.07, 0.5) *
    Eigen::AngleAxisd(2.9, Eigen::Vector3d(1, 0.1, 0.05).normalized());

// By 3 mm and 0.5°.
const Eigen::Isometry3d kBump =
    Eigen::Translation3d(0.002, -0.002, 0.001) *
    Eigen::AngleAxisd(0.5 * M_PI / 180, Eigen::Vector3d(1, 1, 0.3).normalized());

class RigWatchTest : public ::testing::Test {
 protected:
  RigWatchTest() {
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(-0.04, 0.0), Eigen::Vector2d(0.17, 0.0),
                                      Eigen::Vector2d(0.17, 0.12), Eigen::Vector2d(-0.04, 0.12)}) {
      calibration::Fiducial fiducial;
      fiducial.id = 100 + static_cast<int>(scene_.cameras.fiducials.size());
      const Eigen::Vector3d p(at.x(), at.y(), -0.04);
      fiducial.corners = {p + Eigen::Vector3d(0, 0.02, 0), p + Eigen::Vector3d(0.02, 0.02, 0),
                          p + Eigen::Vector3d(0.02, 0, 0), p};
      scene_.cameras.fiducials.push_back(fiducial);
    }
    calibration::FiducialRegistration registration(rig_, scene_.cameras.fiducials);
    for (int i = 0; i < 10; ++i) registration.Add(See(kBefore));
    const vision::RigPose pose = registration.Solve();
    standing_ = {pose.T_rig_robot, pose.covariance, pose, registration.Means()};
  }

  Tags See(const Eigen::Isometry3d& T_rig_robot) {
    constexpr double kSd = 0.05;  // px
    std::normal_distribution<double> noise(0, kSd);
    Tags tags(rig_.cameras.size());
    for (size_t c = 0; c < tags.size(); ++c) {
      const camera::Camera& camera = rig_.cameras[c];
      for (const calibration::Fiducial& fiducial : scene_.cameras.fiducials) {
        vision::Tag tag;
        tag.family = fiducial.family;
        tag.id = fiducial.id;
        for (int i = 0; i < 4; ++i) {
          tag.corners[i] = camera::Project(camera.lens, camera.T_camera_rig *
                                                            (T_rig_robot * fiducial.corners[i]))
                               .pixel +
                           Eigen::Vector2d(noise(random_), noise(random_));
          tag.corner_covariances[i] = kSd * kSd * Eigen::Matrix2d::Identity();
        }
        tags[c].push_back(tag);
      }
    }
    return tags;
  }

  RigWatch MakeWatch() { return {scene_, rig_, standing_, 10, {}}; }

  std::mt19937 random_{1};
  const camera::Rig rig_ = testing::MakeStereoRig();
  scene::Scene scene_;
  Standing standing_;
};

// m, at a corner of the robot's base.
double ErrorOf(const Standing& standing, const Eigen::Isometry3d& truth) {
  const Eigen::Vector3d p(0.15, 0.1, 0);
  return (standing.T_rig_robot * p - truth * p).norm();
}

TEST_F(RigWatchTest, IsQuietWhileNothingMoves) {
  RigWatch watch = MakeWatch();
  for (int frame = 0; frame < 3000; ++frame) {
    const auto verdict = watch.Look(frame, See(kBefore));
    ASSERT_TRUE(verdict.trusted) << frame;
    ASSERT_FALSE(verdict.placed_anew) << frame;
  }
  EXPECT_TRUE(watch.events().empty());
}

TEST_F(RigWatchTest, NoticesABumpAtOnceAndPlacesTheRigAnew) {
  RigWatch watch = MakeWatch();
  const Eigen::Isometry3d after = kBump * kBefore;
  for (int frame = 0; frame < 20; ++frame) watch.Look(frame, See(kBefore));

  EXPECT_FALSE(watch.Look(20, See(after)).trusted);
  EXPECT_FALSE(watch.Look(21, See(after)).trusted);
  const auto verdict = watch.Look(22, See(after));

  EXPECT_TRUE(verdict.trusted);
  EXPECT_TRUE(verdict.placed_anew);
  ASSERT_EQ(watch.events().size(), 1u);
  EXPECT_EQ(watch.events()[0].kind, Kind::kBumped);
  EXPECT_EQ(watch.events()[0].frame, 20);
  EXPECT_EQ(watch.events()[0].told, 22);
  EXPECT_LT(ErrorOf(watch.standing(), after), 0.1e-3);  // m; three frames of 0.05 px
  for (int frame = 23; frame < 40; ++frame) ASSERT_TRUE(watch.Look(frame, See(after)).trusted);
  EXPECT_LT(ErrorOf(watch.standing(), after), 0.06e-3);  // m; ten frames
  EXPECT_EQ(watch.events().size(), 1u);
}

TEST_F(RigWatchTest, WaitsUntilTheRigStandsStill) {
  RigWatch watch = MakeWatch();
  Eigen::Isometry3d now = kBefore;
  for (int frame = 0; frame < 6; ++frame) {
    if (frame > 0) now = Eigen::Translation3d(0.002, 0, 0) * now;
    EXPECT_EQ(watch.Look(frame, See(now)).trusted, frame == 0);
  }
  EXPECT_FALSE(watch.Look(6, See(now)).trusted);
  EXPECT_TRUE(watch.Look(7, See(now)).trusted);
  ASSERT_EQ(watch.events().size(), 1u);
  EXPECT_EQ(watch.events()[0].frame, 1);
}

TEST_F(RigWatchTest, APassingTremorCostsOnlyItsFrames) {
  RigWatch watch = MakeWatch();
  EXPECT_TRUE(watch.Look(0, See(kBefore)).trusted);
  EXPECT_FALSE(watch.Look(1, See(kBump * kBefore)).trusted);
  const auto verdict = watch.Look(2, See(kBefore));
  EXPECT_TRUE(verdict.trusted);
  EXPECT_FALSE(verdict.placed_anew);
  EXPECT_TRUE(watch.events().empty());
}

TEST_F(RigWatchTest, AFiducialThatWasKnockedIsNamedAndLeftOut) {
  RigWatch watch = MakeWatch();
  for (int frame = 0; frame < 20; ++frame) {
    Tags tags = See(kBefore);
    for (auto& of_camera : tags) {
      for (Eigen::Vector2d& corner : of_camera[2].corners) corner.x() += 6;
    }
    ASSERT_TRUE(watch.Look(frame, tags).trusted) << frame;
  }
  ASSERT_EQ(watch.events().size(), 1u);
  EXPECT_EQ(watch.events()[0].kind, Kind::kFiducialMoved);
  EXPECT_EQ(watch.events()[0].frame, 0);
  EXPECT_NE(watch.events()[0].text.find("102"), std::string::npos);
}

TEST_F(RigWatchTest, OneCameraThatMovesAgainstTheOtherEndsTheForces) {
  RigWatch watch = MakeWatch();
  for (int frame = 0; frame < 5; ++frame) {
    Tags tags = See(kBefore);
    tags[1] = See(kBump * kBefore)[1];
    EXPECT_FALSE(watch.Look(frame, tags).trusted) << frame;
  }
  ASSERT_EQ(watch.events().size(), 1u);
  EXPECT_EQ(watch.events()[0].kind, Kind::kCamerasMoved);
}

TEST_F(RigWatchTest, HiddenFiducialsAreNoBump) {
  RigWatch watch = MakeWatch();
  for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(watch.Look(frame, Tags(2)).trusted);
  EXPECT_TRUE(watch.Look(5, {}).trusted);
  EXPECT_TRUE(watch.events().empty());
}

TEST_F(RigWatchTest, AfterADoubtHiddenFiducialsDoNotMakeItGood) {
  RigWatch watch = MakeWatch();
  EXPECT_FALSE(watch.Look(0, See(kBump * kBefore)).trusted);
  EXPECT_FALSE(watch.Look(1, Tags(2)).trusted);
  EXPECT_TRUE(watch.Look(2, See(kBefore)).trusted);
}

}  // namespace
}  // namespace softforce::pipeline
