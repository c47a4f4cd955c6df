#include "pipeline/candidate_count.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

World WorldOf(int markers, int candidates, const Eigen::Matrix3Xd& directions) {
  World world;
  world.markers.resize(markers);
  world.sites.resize(candidates);
  for (estimation::ForceSite& site : world.sites) site.directions = directions;
  return world;
}

TEST(CountCandidates, AsManyCoordinatesAsComponentsAreEnough) {
  EXPECT_TRUE(CountCandidates(WorldOf(12, 12, Eigen::Matrix3d::Identity())).enough());
  EXPECT_FALSE(CountCandidates(WorldOf(12, 13, Eigen::Matrix3d::Identity())).enough());
}

TEST(CountCandidates, APushIsOneComponent) {
  const CandidateCount count = CountCandidates(WorldOf(4, 13, Eigen::Vector3d::UnitZ()));

  EXPECT_EQ(count.components, 13);
  EXPECT_EQ(count.coordinates, 12);
  EXPECT_THAT(count.Warning(), ::testing::AllOf(::testing::HasSubstr("13 force components"),
                                                ::testing::HasSubstr("12 coordinates")));
}

}  // namespace
}  // namespace softforce::pipeline
