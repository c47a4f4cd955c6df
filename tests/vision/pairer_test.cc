#include "vision/pairer.h"

#include <algorithm>
#include <random>

#include "vision/stamp_clock.h"

namespace softforce::vision {
namespace {

constexpr double kPeriod = 1 / 30.0;  // s

// A picture of one pixel that carries its number.
TimedPicture Numbered(int number, double time_s, double arrival_s) {
  return {cv::Mat(1, 1, CV_32SC1, cv::Scalar(number)), time_s, arrival_s};
}
int NumberOf(const TimedPicture& picture) { return picture.grey.at<int>(0, 0); }

TEST(Pairer, PairsTheNearestOfStreamsOutOfPhase) {
  Pairer pairer(2, 1, 10);
  int pairs = 0;
  for (int n = 0; n < 100; ++n) {
    pairer.Add(0, Numbered(n, n * kPeriod, n * kPeriod), kPeriod);
    pairer.Add(1, Numbered(n, (n + 0.4) * kPeriod, (n + 0.4) * kPeriod), kPeriod);
    while (const auto pair = pairer.Take()) {
      EXPECT_EQ(NumberOf((*pair)[0]), NumberOf((*pair)[1]));
      ++pairs;
    }
  }
  EXPECT_EQ(pairs, 100);
  EXPECT_EQ(pairer.tolerance_s(), 0.5 * kPeriod);
}

TEST(Pairer, LeavesOutWhatHasNoPartnerAndCountsIt) {
  Pairer pairer(2, 5e-3, 10);
  for (int n = 0; n < 10; ++n) {
    pairer.Add(0, Numbered(n, n * kPeriod, 0), kPeriod);
    if (n != 4) pairer.Add(1, Numbered(n, n * kPeriod + (n == 7 ? 6e-3 : 1e-3), 0), kPeriod);
  }
  std::vector<int> numbers;
  while (const auto pair = pairer.Take()) {
    EXPECT_EQ(NumberOf((*pair)[0]), NumberOf((*pair)[1]));
    numbers.push_back(NumberOf((*pair)[0]));
  }
  EXPECT_EQ(numbers, (std::vector<int>{0, 1, 2, 3, 5, 6, 8, 9}));
  EXPECT_EQ(pairer.unpaired(0), 2);  // 4 and 7
  EXPECT_EQ(pairer.unpaired(1), 1);  // 7
  EXPECT_EQ(pairer.paired(), 8);
}

TEST(Pairer, TakesACameraThatBeginsAnewWithOtherTimes) {
  Pairer pairer(2, 5e-3, 10);
  pairer.Add(1, Numbered(0, 1000, 0), kPeriod);  // a stamp far off the mark
  pairer.Forget(1);
  pairer.Add(0, Numbered(1, kPeriod, kPeriod), kPeriod);
  pairer.Add(1, Numbered(1, kPeriod, kPeriod), kPeriod);
  EXPECT_TRUE(pairer.Take());
  EXPECT_EQ(pairer.unpaired(1), 1);
}

TEST(Pairer, NeedsAPictureOfEveryCamera) {
  Pairer pairer(3, 5e-3, 10);
  pairer.Add(0, Numbered(0, 0, 0), kPeriod);
  pairer.Add(2, Numbered(0, 0, 0), kPeriod);
  EXPECT_FALSE(pairer.Take());
  pairer.Add(1, Numbered(0, 4e-3, 0), kPeriod);
  EXPECT_EQ(pairer.Take()->size(), 3u);
}

TEST(Pairer, TakesNoneOfThreeThatOnlySpanMoreThanTheTolerance) {
  Pairer pairer(3, 5e-3, 10);
  pairer.Add(0, Numbered(0, 0, 0), kPeriod);
  pairer.Add(1, Numbered(0, 4e-3, 0), kPeriod);
  pairer.Add(2, Numbered(0, 8e-3, 0), kPeriod);
  EXPECT_FALSE(pairer.Take());
  EXPECT_EQ(pairer.unpaired(0), 1);
}

TEST(Pairer, KeepsNothingLongerThanItMayWait) {
  Pairer pairer(2, 5e-3, 0.5);
  for (int n = 0; n < 300; ++n) pairer.Add(0, Numbered(n, n * kPeriod, n * kPeriod), kPeriod);
  EXPECT_EQ(pairer.unpaired(0), 300 - 16);  // 0.5 s hold 15 periods
}

TEST(Pairer, CountsATimeThatGoesBack) {
  Pairer pairer(2, 5e-3, 10);
  pairer.Add(0, Numbered(0, 1, 0), kPeriod);
  pairer.Add(0, Numbered(1, 0.9, 0), kPeriod);
  EXPECT_EQ(pairer.unpaired(0), 1);
}

struct Weather {
  const char* name;
  bool times;       // the streams carry time stamps
  double jitter_s;  // mean
  double left_out;  // share of the pictures, by the camera
  double hold_up;   // share of the pictures that hold up all after them, for up to 300 ms
  double paired;    // share of the pairs that must be found all the same
};

class PairsUnder : public ::testing::TestWithParam<Weather> {};

// A quarter of an hour of two cameras with a common trigger that start at different moments.
TEST_P(PairsUnder, NoTwoPicturesOfDifferentMoments) {
  const Weather weather = GetParam();
  struct Arrival {
    int camera, number;
    double time_s;
  };
  std::mt19937 random(7);
  std::exponential_distribution<double> jitter(1 / weather.jitter_s);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Arrival> arrivals;
  for (int camera = 0; camera < 2; ++camera) {
    double last_s = 0;
    for (int n = camera == 0 ? 0 : 217; n < 27000; ++n) {
      if (uniform(random) < weather.left_out) continue;
      double delay_s = 3e-3 + jitter(random);
      if (uniform(random) < weather.hold_up) delay_s += 0.3 * uniform(random);
      last_s = std::max(last_s, n * kPeriod + delay_s);  // none overtakes another
      arrivals.push_back({camera, n, last_s});
    }
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.time_s < b.time_s; });

  std::vector<StampClock> clocks(2, StampClock(1));
  Pairer pairer(2, 1, 0.5);
  int wrong = 0;
  for (const Arrival& a : arrivals) {
    StampClock& clock = clocks[a.camera];
    const auto stream_s =
        weather.times ? std::optional<double>(a.number * kPeriod + 50 * a.camera) : std::nullopt;
    const auto stamp = clock.Add(a.time_s, stream_s);
    if (!stamp.sure) continue;
    pairer.Add(a.camera, Numbered(a.number, stamp.time_s, a.time_s), clock.period_s());
    while (const auto pair = pairer.Take()) {
      if (NumberOf((*pair)[0]) != NumberOf((*pair)[1])) ++wrong;
    }
  }
  const double possible = (27000 - 217) * (1 - weather.left_out) * (1 - weather.left_out);
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(static_cast<double>(pairer.paired()) / possible, weather.paired);
}

INSTANTIATE_TEST_SUITE_P(Weather, PairsUnder,
                         ::testing::Values(Weather{"Fair", false, 1e-3, 0, 0, 0.98},
                                           Weather{"Jitter", false, 5e-3, 0, 0.005, 0.8},
                                           Weather{"PicturesLeftOut", false, 2e-3, 0.002, 0, 0.8},
                                           Weather{"Everything", false, 4e-3, 0.002, 0.005, 0.3},
                                           Weather{"EverythingWithTimes", true, 10e-3, 0.02, 0.01,
                                                   0.95}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace softforce::vision
