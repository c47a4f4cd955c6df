#include <gtest/gtest.h>

#include "support/allocation_experiment.h"
#include "support/figures.h"

namespace softforce::testing {
namespace {

// A small part of benchmarks/accuracy/allocation_study.cc.
AllocationTally Play(const Disturbance& disturbance, int frames, unsigned seed = 11) {
  AllocationExperiment experiment(disturbance, seed);
  for (int frame = 0; frame < frames; ++frame) experiment.Step();
  return experiment.tally();
}

TEST(AllocationStudy, IsRightWithAThirdHiddenAmongClutter) {
  const AllocationTally tally = Play({0.3, Hiding::kEachFrame, 0.2}, 30);
  EXPECT_EQ(tally.lost_frames, 0);
  EXPECT_EQ(tally.swapped, 0);
  EXPECT_GE(Record("right", tally.RightShare()), 0.999);
  EXPECT_GE(Record("in their regions", double(tally.covered) / tally.regions), 0.95);
  EXPECT_EQ(tally.returned_at_once + tally.returned_next, tally.returns);
}

TEST(AllocationStudy, IsRightWithHalfHiddenForLong) {
  const AllocationTally tally = Play({0.5, Hiding::kSide, 0.2}, 30);
  EXPECT_EQ(tally.lost_frames, 0);
  EXPECT_EQ(tally.swapped, 0);
  EXPECT_GE(Record("right", tally.RightShare()), 0.99);
}

TEST(AllocationStudy, FindsTheMarkersAgainInTheFirstFrameAfterABlackout) {
  const AllocationTally tally = Play({0, Hiding::kEachFrame, 0, 20, 10}, 42);
  EXPECT_EQ(tally.after_blackout, 2);
  EXPECT_EQ(tally.recovered, 2);
  EXPECT_EQ(tally.swapped, 0);
}

// Half of the markers are hidden on one side all the time, and the body goes far in the dark.
TEST(AllocationStudy, FindsTheBodyAgainInAShapeThatItHadBefore) {
  const AllocationTally tally = Play({0.5, Hiding::kSide, 0.2, 50, 20}, 152, 7);
  EXPECT_EQ(tally.after_blackout, 3);
  EXPECT_EQ(tally.recovered, 3);
  EXPECT_EQ(tally.swapped, 0);
}

}  // namespace
}  // namespace softforce::testing
