#include "vision/stamp_clock.h"

#include <random>
#include <vector>

namespace softforce::vision {
namespace {

constexpr double kPeriod = 1 / 30.0;  // s
constexpr double kSettle = 1;         // s

// When picture n comes, at the earliest; the camera's rate is off by 40 ppm.
double Due(int n) { return 1000 + n * kPeriod * (1 + 40e-6); }

TEST(StampClock, IsSureOnlyOnceItHasSettled) {
  StampClock clock(kSettle);
  for (int n = 0; n < 60; ++n) {  // one second, and six pictures in rhythm
    EXPECT_EQ(clock.Add(Due(n), std::nullopt).sure, n >= 30 + 5) << n;
  }
}

TEST(StampClock, TakesTheJitterOutOfAConstantRate) {
  StampClock clock(kSettle);
  std::mt19937 random(1);
  std::exponential_distribution<double> jitter(1 / 3e-3);  // s
  for (int n = 0; n < 3000; ++n) {
    const auto stamp = clock.Add(Due(n) + std::min(jitter(random), 0.4 * kPeriod), std::nullopt);
    // s; at first half of what pairing can bear: the rate from 30 such pictures is off by 0.06 ms a
    // picture. From 600 it is off by 0.7 us, which 150 pictures to the earliest one make 0.1 ms.
    if (stamp.sure) {
      EXPECT_NEAR(stamp.time_s, Due(n), n < 600 ? 0.25 * kPeriod : 1e-3) << n;
    }
  }
  EXPECT_NEAR(clock.period_s(), kPeriod, 1e-5);  // s
  EXPECT_EQ(clock.missed(), 0);
}

TEST(StampClock, IsNotSureOfPicturesThatComeInABurst) {
  StampClock clock(kSettle);
  for (int n = 0; n < 600; ++n) {
    // Pictures 300 to 305 are held up, and come together with 306.
    const bool held = n >= 300 && n < 306;
    const auto stamp = clock.Add(held ? Due(306) : Due(n), std::nullopt);
    if (stamp.sure) {  // s
      EXPECT_NEAR(stamp.time_s, Due(n), 1e-3) << n;
    }
    if (n > 40 && !held) {
      EXPECT_TRUE(stamp.sure) << n;
    }
    if (held && n < 306 - 1) {
      EXPECT_FALSE(stamp.sure) << n;
    }
  }
  EXPECT_EQ(clock.missed(), 0);
}

TEST(StampClock, NoticesPicturesThatTheCameraLeftOut) {
  StampClock clock(kSettle);
  int sure_after = 0;
  for (int n = 0; n < 600; ++n) {
    if (n == 300 || n == 301) continue;
    const auto stamp = clock.Add(Due(n), std::nullopt);
    if (stamp.sure) {  // s
      EXPECT_NEAR(stamp.time_s, Due(n), 1e-3) << n;
    }
    if (n > 302) sure_after += stamp.sure ? 1 : 0;
  }
  EXPECT_EQ(clock.missed(), 2);
  EXPECT_GT(sure_after, 270);
}

TEST(StampClock, LearnsANewRate) {
  StampClock clock(kSettle);
  double time_s = 1000;
  for (int n = 0; n < 900; ++n) {
    time_s += n < 300 ? kPeriod : 2 * kPeriod;  // less light: half the rate
    const auto stamp = clock.Add(time_s, std::nullopt);
    if (stamp.sure) {  // s
      EXPECT_NEAR(stamp.time_s, time_s, 1e-3) << n;
    }
    if (n > 500) {
      EXPECT_TRUE(stamp.sure) << n;
    }
  }
  EXPECT_NEAR(clock.period_s(), 2 * kPeriod, 1e-4);
}

TEST(StampClock, TrustsAStreamThatHasTimesWhateverTheJitter) {
  StampClock clock(kSettle);
  std::mt19937 random(1);
  std::exponential_distribution<double> jitter(1 / 20e-3);  // s
  int64_t left_out = 0;
  for (int n = 0; n < 3000; ++n) {
    if (n > 100 && n % 50 == 0) {
      ++left_out;
      continue;
    }
    const double stream_s = 7 + n * kPeriod;
    const auto stamp = clock.Add(Due(n) + jitter(random), stream_s);
    // s; the earliest of 30 pictures is late by 20 / 30 ms on average, and 5 s of drift add 0.2 ms.
    if (stamp.sure) {
      EXPECT_NEAR(stamp.time_s, Due(n), 5e-3) << n;
    }
    if (n > 40) {
      EXPECT_TRUE(stamp.sure) << n;
    }
  }
  EXPECT_EQ(clock.missed(), left_out);
}

TEST(StampClock, SettlesAgainWhereAStreamsTimesStartAgain) {
  StampClock clock(kSettle);
  for (int n = 0; n < 300; ++n) {
    const auto stamp = clock.Add(Due(n), n < 100 ? n * kPeriod : (n - 100) * kPeriod);
    if (n >= 100 && n < 129) {
      EXPECT_FALSE(stamp.sure) << n;
    }
    if (stamp.sure) {  // s
      EXPECT_NEAR(stamp.time_s, Due(n), 1e-3) << n;
    }
  }
  EXPECT_TRUE(clock.Add(Due(300), 200 * kPeriod).sure);
}

TEST(StampClock, TakesTheDriversStampsAsTheyAre) {
  StampClock clock(kSettle);
  for (int n = 0; n < 30; ++n) {
    if (n == 20) continue;
    const auto stamp = clock.AddExact(Due(n));
    EXPECT_EQ(stamp.time_s, Due(n));
    EXPECT_EQ(stamp.sure, n >= 5) << n;
  }
  EXPECT_EQ(clock.missed(), 1);
}

TEST(StampClock, ForgetsWhatItLearntWhenTheCameraIsOpenedAgain) {
  StampClock clock(kSettle);
  for (int n = 0; n < 60; ++n) clock.Add(Due(n), std::nullopt);
  clock.Restart();
  EXPECT_FALSE(clock.Add(Due(60), std::nullopt).sure);
}

}  // namespace
}  // namespace softforce::vision
