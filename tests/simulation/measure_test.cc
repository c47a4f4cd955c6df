#include "softforce/simulation/measure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::simulation {
namespace {

std::vector<Eigen::Vector3d> Places(int count) {
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i) places.emplace_back(0.01 * i, 0.2, -0.1);
  return places;
}

TEST(MeasureMarkers, AddsNoiseOfTheGivenSize) {
  MeasureOptions options;
  options.noise = 2e-4;
  const auto places = Places(100);
  double sum = 0, squares = 0;
  int count = 0;
  for (int frame = 0; frame < 50; ++frame) {
    const auto measured = MeasureMarkers(places, frame, 0, options, 3);
    for (size_t m = 0; m < places.size(); ++m) {
      for (const double component : Eigen::Vector3d(*measured[m] - places[m])) {
        sum += component;
        squares += component * component;
        ++count;
      }
    }
  }
  // 15000 samples: the mean scatters by 1/122, the standard deviation by 1/173 of the noise. Four
  // times that.
  EXPECT_NEAR(sum / count, 0, 4 * 2e-4 / 122);
  EXPECT_NEAR(std::sqrt(squares / count), 2e-4, 4 * 2e-4 / 173);
}

TEST(MeasureMarkers, GivesTheSameForOneSeedAndSomethingElseForAnother) {
  const auto places = Places(5);
  const auto first = MeasureMarkers(places, 3, 0, {}, 7),
             again = MeasureMarkers(places, 3, 0, {}, 7);
  const auto other_seed = MeasureMarkers(places, 3, 0, {}, 8);
  const auto other_frame = MeasureMarkers(places, 4, 0, {}, 7);
  for (size_t m = 0; m < places.size(); ++m) {
    EXPECT_EQ(*first[m], *again[m]);
    EXPECT_NE(*first[m], *other_seed[m]);
    EXPECT_NE(*first[m], *other_frame[m]);
  }
}

TEST(MeasureMarkers, HidesTheGivenShareAndLeavesTheOthersAsTheyWere) {
  MeasureOptions hiding;
  hiding.hidden_share = 0.3;
  const auto places = Places(50);
  int hidden = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const auto all = MeasureMarkers(places, frame, 0, {}, 1);
    const auto some = MeasureMarkers(places, frame, 0, hiding, 1);
    for (size_t m = 0; m < places.size(); ++m) {
      if (some[m]) {
        EXPECT_EQ(*some[m], *all[m]);
      }
      hidden += !some[m];
    }
  }
  EXPECT_NEAR(hidden, 1500, 4 * std::sqrt(5000 * 0.3 * 0.7));  // binomial, four sigma
}

TEST(MeasureMarkers, LosesMarkersForTheTimeOfADropout) {
  MeasureOptions options;
  options.dropouts = {{0.1, 0.2, {2}}, {0.5, 0.6, {}}};
  const auto seen = [&](double time_s) {
    std::vector<bool> is_seen;
    for (const auto& marker : MeasureMarkers(Places(4), 0, time_s, options, 1)) {
      is_seen.push_back(marker.has_value());
    }
    return is_seen;
  };
  EXPECT_EQ(seen(0.09), std::vector<bool>(4, true));
  EXPECT_EQ(seen(0.1), (std::vector<bool>{true, true, false, true}));
  EXPECT_EQ(seen(0.2), std::vector<bool>(4, true));
  EXPECT_EQ(seen(0.55), std::vector<bool>(4, false));
}

TEST(MeasureOptions, RefusesEachOptionOutOfRange) {
  MeasureOptions options;
  EXPECT_NO_THROW(options.Check());
  options.noise = -1;
  EXPECT_THROW(options.Check(), base::InputError);
  options = {};
  options.hidden_share = 1.5;
  EXPECT_THROW(options.Check(), base::InputError);
  options = {};
  options.dropouts = {{2, 1, {}}};
  EXPECT_THROW(options.Check(), base::InputError);
}

}  // namespace
}  // namespace softforce::simulation
