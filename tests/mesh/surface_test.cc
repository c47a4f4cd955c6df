#include "softforce/mesh/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

const Eigen::Vector3d kSize(0.2, 0.3, 0.1);  // m

Eigen::Vector3d OrientedArea(const Surface& surface, const Eigen::Matrix3Xd& X, int t) {
  const Eigen::Vector3d a = X.col(surface.triangles(0, t)), b = X.col(surface.triangles(1, t));
  const Eigen::Vector3d c = X.col(surface.triangles(2, t));
  return (b - a).cross(c - a) / 2;
}

TEST(ExtractSurface, OfABoxHasTwoTrianglesPerBrickFace) {
  const Surface surface = ExtractSurface(testing::MakeBox(2, 3, 4, kSize));

  EXPECT_EQ(surface.num_triangles(), 2 * 2 * (2 * 3 + 3 * 4 + 4 * 2));
}

TEST(ExtractSurface, IsClosed) {
  const TetMesh box = testing::MakeBox(2, 3, 4, kSize);
  const Surface surface = ExtractSurface(box);

  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int t = 0; t < surface.num_triangles(); ++t) sum += OrientedArea(surface, box.nodes, t);

  EXPECT_LT(sum.norm(), 1e-15);  // m²
}

TEST(ExtractSurface, FacesOutwards) {
  const TetMesh box = testing::MakeBox(2, 3, 4, kSize);
  const Surface surface = ExtractSurface(box);

  double volume = 0;  // by the divergence theorem
  for (int t = 0; t < surface.num_triangles(); ++t) {
    volume += OrientedArea(surface, box.nodes, t).dot(box.nodes.col(surface.triangles(0, t))) / 3;
  }

  EXPECT_NEAR(volume, kSize.prod(), 1e-15);  // m³
}

TEST(ExtractSurface, NamesTheElementBehindEachTriangle) {
  const TetMesh mesh = RaiseOrder(testing::MakeBox(2, 2, 2, kSize));
  const Surface surface = ExtractSurface(mesh);

  ASSERT_EQ(static_cast<int>(surface.element.size()), surface.num_triangles());
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const Eigen::VectorXi nodes = mesh.elements.col(surface.element[t]);
    for (const int node : surface.triangles.col(t)) {
      EXPECT_EQ(std::count(nodes.begin(), nodes.end(), node), 1);
    }
  }
}

TEST(ExtractSurface, OfTenNodeElementsListsTheMiddlesOfEdges01And12And20) {
  const TetMesh mesh = RaiseOrder(testing::MakeBox(2, 1, 2, kSize));

  const Surface surface = ExtractSurface(mesh);

  ASSERT_EQ(surface.order(), 2);
  const auto X = [&](int i, int t) -> Eigen::Vector3d {
    return mesh.nodes.col(surface.triangles(i, t));
  };
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(X(3 + i, t), (X(i, t) + X((i + 1) % 3, t)) / 2);
    }
  }
}

class ClosestSurfacePointOfOrder : public ::testing::TestWithParam<int> {
 protected:
  ClosestSurfacePointOfOrder() : box_(testing::MakeBox(3, 4, 2, kSize)) {
    if (GetParam() == 2) box_ = RaiseOrder(box_);
    surface_ = ExtractSurface(box_);
  }
  TetMesh box_;
  Surface surface_;
};

TEST_P(ClosestSurfacePointOfOrder, OutsideTheBoxIsTheClampedPoint) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.5, 0.8);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d clamped = p.cwiseMax(0).cwiseMin(kSize);
    if (clamped == p) continue;

    const SurfaceProjection found = ClosestSurfacePoint(surface_, box_.nodes, p);

    EXPECT_LT((found.position - clamped).norm(), 1e-14);
    EXPECT_NEAR(found.distance, (p - clamped).norm(), 1e-14);
    EXPECT_LT((Position(surface_, box_.nodes, found.at) - found.position).norm(), 1e-15);
  }
}

TEST_P(ClosestSurfacePointOfOrder, InsideTheBoxIsOnTheNearestWall) {
  const Eigen::Vector3d p(0.09, 0.14, 0.085);

  const SurfaceProjection found = ClosestSurfacePoint(surface_, box_.nodes, p);

  EXPECT_LT((found.position - Eigen::Vector3d(0.09, 0.14, 0.1)).norm(), 1e-14);
}

TEST_P(ClosestSurfacePointOfOrder, OfASurfacePointIsThatPoint) {
  for (int t = 0; t < surface_.num_triangles(); ++t) {
    const SurfacePoint point{t, {0.2, 0.3, 0.5}};
    const Eigen::Vector3d p = Position(surface_, box_.nodes, point);

    const SurfaceProjection found = ClosestSurfacePoint(surface_, box_.nodes, p);

    EXPECT_EQ(found.at.triangle, t);
    EXPECT_LT((found.at.barycentric - point.barycentric).norm(), 1e-12);
    EXPECT_LT(found.distance, 1e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(BothOrders, ClosestSurfacePointOfOrder, ::testing::Values(1, 2));

}  // namespace
}  // namespace softforce::mesh
