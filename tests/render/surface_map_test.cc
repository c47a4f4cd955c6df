#include "softforce/render/surface_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "support/box_mesh.h"

namespace softforce::render {
namespace {

int CountOf(const cv::Mat& picture, const cv::Vec3b& colour) {
  cv::Mat same;
  cv::inRange(picture, cv::Scalar(colour), cv::Scalar(colour), same);
  return cv::countNonZero(same);
}

class SurfaceMapTest : public ::testing::Test {
 protected:
  SurfaceMapTest() {
    box_ = testing::MakeBox(4, 4, 1, {0.1, 0.08, 0.01});
    surface_ = mesh::ExtractSurface(box_);
    row_.values = Eigen::VectorXd::Constant(surface_.num_triangles(), 3);
  }

  cv::Mat Draw(const Eigen::Vector3d& direction) {
    return DrawSurfaceMaps(surface_, box_.nodes, {PlainView("view", box_.nodes, direction)}, {row_},
                           scale_);
  }

  mesh::TetMesh box_;
  mesh::Surface surface_;
  MapScale scale_{"error, mm", 1, 10};
  MapRow row_;
};

TEST_F(SurfaceMapTest, TheBodyHasTheColourOfItsValue) {
  const cv::Mat picture = Draw(Eigen::Vector3d::UnitZ());

  // The panel is 720 × 560 px, and the box as 100 : 80 fills 92 % of its height.
  const double expected = std::pow(0.92 * 560, 2) * 100 / 80;
  EXPECT_NEAR(CountOf(picture, MapColour(3, scale_)), expected, 0.05 * expected);  // its outline
}

TEST_F(SurfaceMapTest, WhatIsBehindIsNotSeen) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (int t = 0; t < surface_.num_triangles(); ++t) {
    const mesh::SurfacePoint middle{t, Eigen::Vector3d::Constant(1.0 / 3)};
    if (mesh::Normal(surface_, box_.nodes, middle).dot(up) < -0.5) row_.values(t) = 8;
  }
  const cv::Vec3b below = MapColour(8, scale_);
  const int in_scale = CountOf(Draw(up), below);

  EXPECT_LT(in_scale, 400);  // px: a line of the scale at most
  EXPECT_GT(CountOf(Draw(-up), below), 100000);
}

TEST_F(SurfaceMapTest, MarkersOnTheFarSideAreNotDrawn) {
  const cv::Mat without = Draw(Eigen::Vector3d::UnitZ());
  row_.labels = {"7"};
  row_.markers = {{0.05, 0.04, 0}};
  const cv::Mat hidden = Draw(Eigen::Vector3d::UnitZ());
  row_.markers = {{0.05, 0.04, 0.01}};
  const cv::Mat seen = Draw(Eigen::Vector3d::UnitZ());

  EXPECT_EQ(cv::norm(without, hidden, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(without, seen, cv::NORM_INF), 0);
}

TEST_F(SurfaceMapTest, ColoursRiseInLightnessAndEndAtTheScalesEnds) {
  double before = -1;
  for (const double value : {1.0, 1.5, 2.2, 3.3, 5.0, 7.0, 10.0}) {
    const cv::Vec3b colour = MapColour(value, scale_);
    const double lightness = 0.11 * colour(0) + 0.59 * colour(1) + 0.3 * colour(2);
    EXPECT_GT(lightness, before) << value;
    before = lightness;
  }
  EXPECT_EQ(MapColour(0.1, scale_), MapColour(1, scale_));
  EXPECT_EQ(MapColour(100, scale_), MapColour(10, scale_));
}

}  // namespace
}  // namespace softforce::render
