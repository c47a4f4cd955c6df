#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <numeric>
#include <random>

#include "softforce/mesh/surface.h"
#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

// A box, raised to the order in question, and points all over its surface.
class ShapeFunctionsOfOrder : public ::testing::TestWithParam<int> {
 protected:
  ShapeFunctionsOfOrder() : box_(testing::MakeBox(2, 2, 1, {0.2, 0.3, 0.1})) {
    if (GetParam() == 2) box_ = RaiseOrder(box_);
    surface_ = ExtractSurface(box_);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.05, 1);
    for (int t = 0; t < surface_.num_triangles(); ++t) {
      const Eigen::Vector3d weights(uniform(random), uniform(random), uniform(random));
      points_.push_back({t, weights / weights.sum()});
    }
  }
  TetMesh box_;
  Surface surface_;
  std::vector<SurfacePoint> points_;
};

TEST_P(ShapeFunctionsOfOrder, AddUpToOne) {
  for (const SurfacePoint& point : points_) {
    const auto weights = ShapeFunctions(surface_, point).weights;
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-15);
  }
}

TEST_P(ShapeFunctionsOfOrder, ListEachNodeOnceInAscendingOrder) {
  for (const SurfacePoint& point : points_) {
    const auto nodes = ShapeFunctions(surface_, point).nodes;
    EXPECT_EQ(std::adjacent_find(nodes.begin(), nodes.end(), std::greater_equal<>()), nodes.end());
  }
}

TEST_P(ShapeFunctionsOfOrder, AreOneAtTheirOwnCorner) {
  for (int corner = 0; corner < 3; ++corner) {
    const SurfacePoint point{5, Eigen::Vector3d::Unit(corner)};
    EXPECT_EQ(Position(surface_, box_.nodes, point), box_.nodes.col(surface_.triangles(corner, 5)));
  }
}

TEST_P(ShapeFunctionsOfOrder, AppliedToTheNodesArePosition) {
  for (const SurfacePoint& point : points_) {
    const Eigen::Vector3d applied = ShapeFunctions(surface_, point).Apply(box_.nodes);
    EXPECT_LT((applied - Position(surface_, box_.nodes, point)).norm(), 1e-15);
  }
}

// A field that the shape functions must reproduce: affine at order 1, quadratic at order 2.
Eigen::Matrix3Xd Field(int order, const Eigen::Matrix3Xd& X) {
  const Eigen::ArrayXXd x = 1 + X.array() * 3;
  Eigen::Matrix3Xd field = x.matrix();
  if (order == 1) return field;
  field.row(0) = x.row(0) * x.row(1) - x.row(2).square();
  field.row(1) = x.row(1).square() + x.row(2) * x.row(0);
  return field;
}

TEST_P(ShapeFunctionsOfOrder, ReproducePolynomialsOfThatDegree) {
  const Eigen::Matrix3Xd field = Field(GetParam(), box_.nodes);
  for (const SurfacePoint& point : points_) {
    const Eigen::Vector3d exact = Field(GetParam(), Position(surface_, box_.nodes, point));
    EXPECT_LT((ShapeFunctions(surface_, point).Apply(field) - exact).norm(), 1e-14);
  }
}

TEST_P(ShapeFunctionsOfOrder, NormalIsThatOfTheDeformedSurface) {
  Eigen::Matrix3Xd x = box_.nodes;  // bent, so that 6-node triangles are curved
  x.row(2) += 2 * box_.nodes.row(0).array().square().matrix();
  x.row(1) += (box_.nodes.row(0).array() * box_.nodes.row(2).array()).matrix();
  constexpr double kStep = 1e-6;
  for (const SurfacePoint& point : points_) {
    const auto moved = [&](int toward, double step) {
      SurfacePoint there = point;
      there.barycentric(toward) += step;
      there.barycentric(0) -= step;
      return Position(surface_, x, there);
    };
    const Eigen::Vector3d along_1 = moved(1, kStep) - moved(1, -kStep);
    const Eigen::Vector3d along_2 = moved(2, kStep) - moved(2, -kStep);

    const Eigen::Vector3d normal = Normal(surface_, x, point);

    EXPECT_LT((normal - along_1.cross(along_2).normalized()).norm(), 1e-8);  // rounding / step
  }
}

INSTANTIATE_TEST_SUITE_P(BothOrders, ShapeFunctionsOfOrder, ::testing::Values(1, 2));

}  // namespace
}  // namespace softforce::mesh
