#include "softforce/mesh/surface_walk.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

constexpr double kRounding = 1e-12;  // m

// A box of 40 × 30 × 20 mm.
class OnABox : public ::testing::Test {
 protected:
  OnABox() : box_(testing::MakeBox(5, 4, 3, {0.04, 0.03, 0.02})), surface_(ExtractSurface(box_)) {}

  SurfacePoint At(const Eigen::Vector3d& p) const {
    return ClosestSurfacePoint(surface_, box_.nodes, p).at;
  }
  std::vector<int> OneRegion() const { return std::vector<int>(surface_.num_triangles(), 0); }
  std::vector<int> Faces() const { return SmoothFaces(surface_, box_.nodes, 0.8); }

  TetMesh box_;
  Surface surface_;
};

TEST_F(OnABox, AStepOnAFaceIsStraight) {
  const SurfaceWalk walk(surface_, box_.nodes, OneRegion());
  const Eigen::Vector3d start(0.0041, 0.0052, 0.02), step(0.0307, 0.0191, 0);

  const SurfacePoint end = walk.Step(At(start), step);

  EXPECT_LT((walk.Position(end) - (start + step)).norm(), kRounding);
}

TEST_F(OnABox, AStepOverACreaseKeepsItsLengthAndItsAngle) {
  const SurfaceWalk walk(surface_, box_.nodes, OneRegion());
  const Eigen::Vector3d start(0.0341, 0.0152, 0.02);

  const SurfacePoint end = walk.Step(At(start), {0.0159, 0.003, 0});  // 5.9 mm to the edge x = 40

  const Eigen::Vector3d expected(0.04, 0.0182, 0.01);  // and 10 mm down the side
  EXPECT_LT((walk.Position(end) - expected).norm(), kRounding);
}

TEST_F(OnABox, AWalkAroundTheBoxComesBack) {
  const SurfaceWalk walk(surface_, box_.nodes, OneRegion());
  const Eigen::Vector3d start(0.0111, 0.0152, 0.02);

  const SurfacePoint end = walk.Step(At(start), {2 * (0.04 + 0.02), 0, 0});

  EXPECT_LT((walk.Position(end) - start).norm(), kRounding);
}

TEST_F(OnABox, AtTheEndOfItsRegionItSlidesAlongTheEdge) {
  const SurfaceWalk walk(surface_, box_.nodes, Faces());
  const Eigen::Vector3d start(0.0341, 0.0052, 0.02);

  const SurfacePoint end = walk.Step(At(start), {0.0159, 0.0106, 0});

  EXPECT_LT((walk.Position(end) - Eigen::Vector3d(0.04, 0.0158, 0.02)).norm(), kRounding);
}

TEST_F(OnABox, InACornerOfItsRegionItStays) {
  const SurfaceWalk walk(surface_, box_.nodes, Faces());

  const SurfacePoint end = walk.Step(At({0.0341, 0.0252, 0.02}), {0.05, 0.06, 0});

  EXPECT_LT((walk.Position(end) - Eigen::Vector3d(0.04, 0.03, 0.02)).norm(), kRounding);
}

TEST_F(OnABox, TangentsSpanTheTrianglesPlane) {
  const SurfaceWalk walk(surface_, box_.nodes, OneRegion());
  for (int t = 0; t < surface_.num_triangles(); ++t) {
    const Eigen::Matrix<double, 3, 2> tangents = walk.Tangents(t);
    const SurfacePoint middle{t, Eigen::Vector3d::Constant(1.0 / 3)};
    EXPECT_LT((tangents.transpose() * tangents - Eigen::Matrix2d::Identity()).norm(), kRounding);
    EXPECT_LT((tangents.transpose() * Normal(surface_, box_.nodes, middle)).norm(), kRounding);
  }
}

TEST_F(OnABox, ItsSixSidesAreItsSmoothFaces) {
  const std::vector<int> faces = Faces();

  EXPECT_EQ(std::set<int>(faces.begin(), faces.end()).size(), 6);
}

}  // namespace
}  // namespace softforce::mesh
