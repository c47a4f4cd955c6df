#include "softforce/vision/marker_tracks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/stereo_rig.h"

namespace softforce::vision {
namespace {

constexpr double kRate = 30;  // Hz

// px; spots 40 px apart that swing by 30 px, far more than halfway to the next one.
Eigen::Vector2d Swinging(int spot, double t) {
  return {100 + 40 * spot, 200 + 30 * std::sin(2 * M_PI * t)};
}

TEST(SpotFollower, FollowsSpotsThatGoFurtherThanTheirNeighboursAre) {
  SpotFollower follower;
  for (int k = 0; k < 60; ++k) {
    std::vector<Eigen::Vector2d> spots;
    for (int s = 0; s < 5; ++s) spots.push_back(Swinging(s, k / kRate));
    std::rotate(spots.begin(), spots.begin() + k % 5, spots.end());  // they come without names
    follower.Add(k / kRate, spots);
  }

  const std::vector<Track> tracks = follower.Tracks();

  ASSERT_EQ(tracks.size(), 5u);
  for (const Track& track : tracks) {
    ASSERT_EQ(track.size(), 60u);
    for (const TimedPixel& seen : track) {
      EXPECT_EQ(seen.pixel.x(), track.front().pixel.x());  // each stays in its column
    }
  }
}

TEST(SpotFollower, BeginsAnewWhereASpotWasHiddenForLong) {
  SpotFollower follower(0.1);
  for (int k = 0; k < 60; ++k) {
    const bool hidden = k >= 25 && k < 35;
    follower.Add(k / kRate, hidden ? std::vector<Eigen::Vector2d>()
                                   : std::vector<Eigen::Vector2d>{{100, 100}});
  }
  ASSERT_EQ(follower.Tracks(20).size(), 2u);
  EXPECT_EQ(follower.Tracks(20)[0].size(), 25u);
  EXPECT_EQ(follower.Tracks(26).size(), 0u);  // those are too short
}

TEST(SpotFollower, DoesNotJumpToASpotThatAppearsFarAway) {
  SpotFollower follower;
  for (int k = 0; k < 60; ++k) {
    follower.Add(k / kRate, {k < 30 ? Eigen::Vector2d(100, 100) : Eigen::Vector2d(300, 100)});
  }
  EXPECT_EQ(follower.Tracks().size(), 2u);
}

// m; a grid of 4 x 3 markers, each moving in its own way.
Eigen::Vector3d MarkerAt(int marker, double t) {
  const double phase = 0.9 * marker;
  return {0.02 * (marker % 4) - 0.03, 0.02 * (marker / 4) - 0.02 + 4e-3 * std::sin(7 * t + phase),
          0.45 + 2e-3 * std::sin(3 * t + phase)};
}

TEST(PairTracks, FindsPartnersWithoutKnowingTheOffset) {
  const camera::Rig rig = testing::MakeStereoRig();
  constexpr double kLate = 0.045;  // s
  std::vector<Track> left(12), right(12);
  for (int m = 0; m < 12; ++m) {
    for (int k = 0; k < 90; ++k) {
      const double t = k / kRate;
      const auto seen = testing::ProjectInto(rig, MarkerAt(m, t));
      left[m].push_back({t, seen[0].pixel});
      right[11 - m].push_back({t + kLate, seen[1].pixel});
    }
  }
  right[3].clear();  // of marker 8: the other camera does not see it

  const std::vector<TrackPair> pairs = PairTracks(rig, 0, 1, left, right);

  ASSERT_EQ(pairs.size(), 11u);
  for (const TrackPair& pair : pairs) {
    const auto marker = std::find_if(left.begin(), left.end(),
                                     [&](const Track& track) {
                                       return track.front().pixel == pair.in_first.front().pixel;
                                     }) -
                        left.begin();
    EXPECT_EQ(pair.in_second.front().pixel, right[11 - marker].front().pixel) << marker;
  }
  const TimeOffset found = EstimateTimeOffset(rig, 0, 1, pairs);
  EXPECT_NEAR(found.offset_s, kLate, 2e-5);  // s; what cubics between pictures miss
}

TEST(PairTracks, GivesNothingForNothing) {
  EXPECT_TRUE(PairTracks(testing::MakeStereoRig(), 0, 1, {}, {}).empty());
}

}  // namespace
}  // namespace softforce::vision
