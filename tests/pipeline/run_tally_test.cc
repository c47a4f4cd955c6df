#include "pipeline/run_tally.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using Status = estimation::ForceEstimate::Status;

FrameResult Frame(int number, Status status) {
  FrameResult result;
  result.frame = number;
  result.status = status;
  if (status == Status::kOk) result.forces.emplace_back();
  return result;
}

RunTally Tally(int good, int lost) {
  RunTally tally;
  for (int i = 0; i < good; ++i) tally.Add(Frame(i, Status::kOk));
  for (int i = 0; i < lost; ++i) tally.Add(Frame(good + i, Status::kTooFewObservations));
  return tally;
}

TEST(RunTally, IsUsableIfMostFramesHaveForces) {
  for (const auto& [good, lost, usable] : {std::tuple(3, 2, true), std::tuple(2, 3, false)}) {
    RunTally tally = Tally(good, lost);
    tally.Judge({}, {});
    EXPECT_EQ(tally.report.usable, usable) << good << " and " << lost;
  }
}

TEST(RunTally, IsNotUsableIfTheRecordingFellShort) {
  RunTally tally = Tally(3, 0);
  tally.Judge({}, {"left.mp4: ended early"});
  EXPECT_FALSE(tally.report.usable);
  EXPECT_THAT(tally.report.warnings, Contains("left.mp4: ended early"));
}

TEST(RunTally, TellsOfSingleLostFramesOnlySoOften) {
  RunTally tally = Tally(100, 50);
  tally.Judge({}, {});
  EXPECT_EQ(tally.report.warnings.size(), 21u);
  EXPECT_THAT(tally.report.warnings, Contains("30 more frames without forces"));
}

TEST(RunTally, TellsHowLiveCamerasFared) {
  RunTally tally = Tally(9, 0);
  tally.report.live = true;
  tally.report.source.delivered = 9;
  tally.report.source.dropped = 4;
  vision::CameraReport camera;
  camera.camera = "left";
  camera.received = 20;
  camera.unpaired = 5;
  camera.unsure = 2;
  tally.report.source.cameras.push_back(camera);
  tally.Judge({"camera \"left\" went away"}, {});

  EXPECT_TRUE(tally.report.usable);
  EXPECT_THAT(tally.report.warnings, Contains("camera \"left\" went away"));
  EXPECT_THAT(tally.report.warnings, Contains(HasSubstr("4 of 13 sets of pictures were dropped")));
  EXPECT_THAT(tally.report.warnings, Contains(HasSubstr("of 20 pictures 5 had no partner, and 2")));
}

}  // namespace
}  // namespace softforce::pipeline
