#include "pipeline/frame_rate.h"

#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

using std::chrono::milliseconds;

TEST(FrameRate, CountsTheFramesOfTheLastSeconds) {
  FrameRate rate;
  const FrameRate::Clock::time_point start{};
  EXPECT_EQ(rate.PerSecond(start), 0);
  for (int i = 0; i < 200; ++i) rate.Add(start + milliseconds(50 * i));

  EXPECT_NEAR(rate.PerSecond(start + milliseconds(50 * 199)), 20, 1);  // one frame in two seconds
}

TEST(FrameRate, FallsToNothingWhereNoFrameComes) {
  FrameRate rate;
  const FrameRate::Clock::time_point start{};
  for (int i = 0; i < 20; ++i) rate.Add(start + milliseconds(50 * i));

  EXPECT_LT(rate.PerSecond(start + milliseconds(2000)), 12);
  EXPECT_EQ(rate.PerSecond(start + milliseconds(3000)), 0);
}

}  // namespace
}  // namespace softforce::pipeline
