#include "softforce/mesh/spread_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

// The upper face of a plate of 100 × 60 × 8 mm.
class SpreadPointsTest : public ::testing::Test {
 protected:
  SpreadPointsTest() {
    for (int t = 0; t < surface_.num_triangles(); ++t) {
      if (Place({t, Eigen::Vector3d::Constant(1.0 / 3)}).z() > 0.008 - 1e-9) top_.push_back(t);
    }
  }

  Eigen::Vector3d Place(const SurfacePoint& at) const {
    return Position(surface_, plate_.nodes, at);
  }

  template <typename Suitable>
  std::vector<Eigen::Vector3d> Spread(double spacing, const Suitable& suitable) const {
    std::vector<Eigen::Vector3d> places;
    for (const SurfacePoint& at : SpreadPoints(surface_, plate_.nodes, top_, spacing, suitable)) {
      places.push_back(Place(at));
    }
    return places;
  }

  static bool Any(const SurfacePoint& /*at*/) { return true; }

  TetMesh plate_ = testing::MakeBox(10, 6, 1, {0.1, 0.06, 0.008});
  Surface surface_ = ExtractSurface(plate_);
  std::vector<int> top_;
};

double FromNearest(const Eigen::Vector3d& place, const std::vector<Eigen::Vector3d>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& other : others) least = std::min(least, (place - other).norm());
  return least;
}

TEST_F(SpreadPointsTest, AreASpacingApartAndLeaveNoHole) {
  const double spacing = 0.012;  // m
  const std::vector<Eigen::Vector3d> places = Spread(spacing, Any);

  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(places[i].z(), 0.008, 1e-12);  // m; rounding
    for (size_t j = 0; j < i; ++j) EXPECT_GE((places[i] - places[j]).norm(), spacing);
  }
  for (int x = 0; x <= 100; x += 7) {
    for (int y = 0; y <= 60; y += 6) {
      const Eigen::Vector3d here(1e-3 * x, 1e-3 * y, 0.008);
      // The nearest sample may be a quarter of the spacing off.
      EXPECT_LE(FromNearest(here, places), 1.25 * spacing) << here.transpose();
    }
  }
}

TEST_F(SpreadPointsTest, DoNotDependOnTheMeshMuch) {
  const size_t here = Spread(0.02, Any).size();
  const TetMesh finer = testing::MakeBox(27, 17, 2, {0.1, 0.06, 0.008});
  const Surface surface = ExtractSurface(finer);
  std::vector<int> top;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const SurfacePoint middle{t, Eigen::Vector3d::Constant(1.0 / 3)};
    if (Position(surface, finer.nodes, middle).z() > 0.008 - 1e-9) top.push_back(t);
  }

  const size_t there = SpreadPoints(surface, finer.nodes, top, 0.02, Any).size();

  // Discs of that distance: hexagonal packing holds 17 on the face, and its rim lets in some more.
  EXPECT_GE(here, 10u);
  EXPECT_LE(here, 24u);
  EXPECT_NEAR(static_cast<double>(here), static_cast<double>(there), 5);
}

TEST_F(SpreadPointsTest, StayWhereTheyAreSuitable) {
  const std::vector<Eigen::Vector3d> places =
      Spread(0.01, [&](const SurfacePoint& at) { return Place(at).x() > 0.06; });

  ASSERT_GT(places.size(), 10u);
  for (const Eigen::Vector3d& place : places) EXPECT_GT(place.x(), 0.06);
}

TEST_F(SpreadPointsTest, BeginInTheMiddle) {
  const std::vector<Eigen::Vector3d> places = Spread(0.2, Any);

  ASSERT_EQ(places.size(), 1u);
  EXPECT_LT((places[0] - Eigen::Vector3d(0.05, 0.03, 0.008)).norm(), 0.01);  // m; a cell's size
}

TEST_F(SpreadPointsTest, ThereAreNoneIfNothingIsSuitable) {
  EXPECT_TRUE(Spread(0.02, [](const SurfacePoint&) { return false; }).empty());
}

}  // namespace
}  // namespace softforce::mesh
