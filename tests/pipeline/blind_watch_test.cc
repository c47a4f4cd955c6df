#include "pipeline/blind_watch.h"

#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

using Kind = BlindWatch::Finding::Kind;

// Five markers, each at a node of its own, and the dots that a camera sees of them.
class BlindWatchTest : public ::testing::Test {
 protected:
  BlindWatchTest() {
    X_ << 0, 0.1, 0, 0.1, 0.05, 0, 0, 0.1, 0.1, 0.05, 0, 0, 0, 0, 0.02;  // m
    u_.setZero();
  }

  // A frame in which the markers are off by `moved`, m, and one of them by `alone`, m.
  std::optional<BlindWatch::Finding> Look(int frame, double moved, bool usable, double alone = 0) {
    std::vector<MarkerObservation> observations;
    for (int i = 0; i < 5; ++i) {
      MarkerObservation observation;
      observation.feature = i;
      observation.seen.at = {{i}, {1.0}};
      observation.seen.offset.setZero();
      observation.seen.position = X_.col(i) + Eigen::Vector3d(moved, 0, 0);
      if (i == 4) observation.seen.position.z() += alone;
      observation.seen.whitening = Eigen::Matrix3d::Identity();
      observations.push_back(observation);
    }
    return watch_.Look({frame, usable, Dots(moved), observations, X_, u_, 0.005, standing_});
  }

  static std::vector<CameraDetections> Dots(double moved) {
    std::vector<CameraDetections> cameras(1);
    for (int i = 0; i < 5; ++i) {
      vision::Dot dot;
      dot.centroid = {100.0 * i + 2000 * moved, 200};  // 2 px per mm
      cameras[0].dots.push_back(dot);
    }
    return cameras;
  }

  BlindWatch watch_;
  Eigen::Matrix3Xd X_{3, 5}, u_{3, 5};
  Standing standing_{Eigen::Isometry3d::Identity(), geometry::Matrix6d::Zero(), {}, {}};
};

TEST_F(BlindWatchTest, TellsOnceAfterTenFramesThatForcesCanBeMadeUpFor) {
  int told = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const auto finding = Look(frame, 2e-3, true);
    if (!finding) continue;
    ++told;
    EXPECT_EQ(frame, 9);
    EXPECT_EQ(finding->kind, Kind::kOffAlike);
    EXPECT_EQ(finding->frame, 0);
    EXPECT_NEAR(finding->moved, 2e-3, 1e-9);
    EXPECT_TRUE(watch_.WorthATry(Dots(2e-3)));
  }
  EXPECT_EQ(told, 1);
}

TEST_F(BlindWatchTest, DoesNotTakeOneMarkerForAll) {
  for (int frame = 0; frame < 30; ++frame) EXPECT_FALSE(Look(frame, 0, true, 5e-3));
}

TEST_F(BlindWatchTest, TriesFewFramesOnceNoForcesExplainThem) {
  Look(0, 0, true);
  EXPECT_FALSE(Look(1, 5e-3, false));
  EXPECT_FALSE(Look(2, 5e-3, false));
  ASSERT_TRUE(Look(3, 5e-3, false));
  int tried = 0;
  for (int frame = 4; frame < 1004; ++frame) {
    if (!watch_.WorthATry(Dots(5e-3))) continue;
    ++tried;
    EXPECT_FALSE(Look(frame, 5e-3, false));
  }
  EXPECT_EQ(tried, 6);  // after 30, 60, 120 and then every 240 frames
}

TEST_F(BlindWatchTest, GoesOnAtOnceWhenTheRigIsPutBack) {
  Look(0, 0, true);
  for (int frame = 1; frame < 4; ++frame) Look(frame, 5e-3, false);
  ASSERT_FALSE(watch_.WorthATry(Dots(5e-3)));
  ASSERT_TRUE(watch_.WorthATry(Dots(0.3e-3)));
  const auto finding = Look(5, 0, true);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->kind, Kind::kBack);
  EXPECT_EQ(finding->frame, 5);
  EXPECT_TRUE(watch_.WorthATry(Dots(5e-3)));
}

TEST_F(BlindWatchTest, ForgetsWhenFiducialsAreInView) {
  Look(0, 0, true);
  for (int frame = 1; frame < 4; ++frame) Look(frame, 5e-3, false);
  watch_.Forget();
  EXPECT_TRUE(watch_.WorthATry(Dots(5e-3)));
}

}  // namespace
}  // namespace softforce::pipeline
