#include "pipeline/tare.h"

#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

FrameResult Frame(int frame, const Eigen::Vector3d& force, int identity = 0) {
  FrameResult result;
  result.frame = frame;
  result.status = estimation::ForceEstimate::Status::kOk;
  ForceResult one;
  one.identity = identity;
  one.force = force;
  one.covariance = Eigen::Matrix3d::Identity();
  result.forces.push_back(one);
  return result;
}

FrameResult Applied(Tare* tare, FrameResult frame) {
  tare->Apply(&frame);
  return frame;
}

TEST(Tare, LeavesForcesAloneUntilItIsAsked) {
  RunControls controls;
  Tare tare(&controls);

  const FrameResult frame = Applied(&tare, Frame(0, {0, 0, 1}));

  EXPECT_EQ(frame.forces[0].force.z(), 1);
  EXPECT_EQ(frame.forces[0].covariance(0, 0), 1);
  EXPECT_TRUE(tare.messages().empty());
}

TEST(Tare, CountsFromTheMeanOfTheNextFrames) {
  RunControls controls;
  Tare tare(&controls);
  ++controls.tares;
  for (int i = 0; i < Tare::kFrames; ++i) {
    EXPECT_EQ(controls.tared, 0);
    Applied(&tare, Frame(i, {0, 0, i % 2 == 0 ? 1.0 : 2.0}));
  }

  const FrameResult frame = Applied(&tare, Frame(Tare::kFrames, {0, 0, 5}));

  EXPECT_NEAR(frame.forces[0].force.z(), 3.5, 1e-12);  // N; up to rounding
  // The mean's own variance is added.
  EXPECT_NEAR(frame.forces[0].covariance(2, 2), 1 + 1.0 / Tare::kFrames, 1e-12);  // N²
  EXPECT_EQ(controls.tared, 1);
  EXPECT_EQ(tare.messages().size(), 1);
}

TEST(Tare, TakesASecondRequestFromTheForcesThemselves) {
  RunControls controls;
  Tare tare(&controls);
  for (const double z : {1.0, 4.0}) {
    ++controls.tares;
    for (int i = 0; i < Tare::kFrames; ++i) Applied(&tare, Frame(i, {0, 0, z}));
  }

  EXPECT_NEAR(Applied(&tare, Frame(99, {0, 0, 5})).forces[0].force.z(), 1, 1e-12);  // N
}

TEST(Tare, WaitsForFramesWithForces) {
  RunControls controls;
  Tare tare(&controls);
  ++controls.tares;
  for (int i = 0; i < 2 * Tare::kFrames; ++i) Applied(&tare, FrameResult());

  EXPECT_EQ(controls.tared, 0);
}

TEST(Tare, LeavesAForceAloneThatWasNotThere) {
  RunControls controls;
  Tare tare(&controls);
  ++controls.tares;
  for (int i = 0; i < Tare::kFrames; ++i) Applied(&tare, Frame(i, {0, 0, 1}, 0));

  EXPECT_EQ(Applied(&tare, Frame(99, {0, 0, 5}, 1)).forces[0].force.z(), 5);
}

}  // namespace
}  // namespace softforce::pipeline
