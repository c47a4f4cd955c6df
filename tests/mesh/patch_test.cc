#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "softforce/mesh/patches.h"
#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

constexpr double kDiameter = 0.006;  // m

// A sheet of 40 × 40 × 2 mm, whose thickness is less than the patch.
class PatchOfOrder : public ::testing::TestWithParam<int> {
 protected:
  PatchOfOrder() : sheet_(testing::MakeBox(9, 9, 1, {0.04, 0.04, 0.002})) {
    if (GetParam() == 2) sheet_ = RaiseOrder(sheet_);
    surface_ = ExtractSurface(sheet_);
  }

  NodalWeights PatchAt(const Eigen::Vector3d& p, double diameter = kDiameter) const {
    const SurfacePoint centre = ClosestSurfacePoint(surface_, sheet_.nodes, p).at;
    return PatchWeights(surface_, sheet_.nodes, centre, diameter);
  }

  TetMesh sheet_;
  Surface surface_;
};

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST_P(PatchOfOrder, WeightsAddUpToOne) {
  EXPECT_NEAR(Sum(PatchAt({0.0171, 0.0233, 0.002}).weights), 1, 1e-14);
  EXPECT_NEAR(Sum(PatchAt({0.04, 0.04, 0.002}).weights), 1, 1e-14);  // at a corner of the body
}

TEST_P(PatchOfOrder, MeanPositionOnAFlatFaceIsTheCentre) {
  const Eigen::Vector3d centre(0.0171, 0.0233, 0.002);

  const Eigen::Vector3d mean = PatchAt(centre).Apply(sheet_.nodes);

  EXPECT_LT((mean - centre).norm(), 1e-15);  // m
}

TEST_P(PatchOfOrder, StaysOnItsSideOfAThinBody) {
  for (const int node : PatchAt({0.0171, 0.0233, 0.002}).nodes) {
    EXPECT_EQ(sheet_.nodes(2, node), 0.002);
  }
}

TEST_P(PatchOfOrder, BeyondAnEdgeCountsAtTheEdge) {
  // The mean of max(0, r cos a) over the outer half disc is the distance that the edge takes away:
  // 2/(3π) of the radius.
  const Eigen::Vector3d on_edge(0.04, 0.0203, 0.002);

  const Eigen::Vector3d mean = PatchAt(on_edge).Apply(sheet_.nodes);

  const double expected = 0.04 - 2 / (3 * M_PI) * kDiameter / 2;
  EXPECT_NEAR(mean.x(), expected, 0.005 * kDiameter);  // the edge is a kink for the quadrature
  EXPECT_NEAR(mean.y(), 0.0203, 1e-9);
}

TEST_P(PatchOfOrder, OfDiameterZeroIsThePoint) {
  const SurfacePoint centre{7, {0.2, 0.3, 0.5}};

  const NodalWeights patch = PatchWeights(surface_, sheet_.nodes, centre, 0);

  EXPECT_EQ(patch.nodes, ShapeFunctions(surface_, centre).nodes);
  EXPECT_EQ(patch.weights, ShapeFunctions(surface_, centre).weights);
}

TEST_P(PatchOfOrder, IsDeterministic) {
  const NodalWeights one = PatchAt({0.0171, 0.0233, 0.002});
  const NodalWeights other = PatchAt({0.0171, 0.0233, 0.002});

  EXPECT_EQ(one.nodes, other.nodes);
  EXPECT_EQ(one.weights, other.weights);
}

TEST_P(PatchOfOrder, AgreesWithAFineSumOverTheDisc) {
  const Eigen::Vector3d centre(0.0171, 0.0233, 0.002);
  const NodalWeights patch = PatchAt(centre);

  Eigen::VectorXd fine = Eigen::VectorXd::Zero(sheet_.num_nodes());
  constexpr int kSteps = 40;
  int count = 0;
  for (int i = -kSteps; i < kSteps; ++i) {
    for (int j = -kSteps; j < kSteps; ++j) {
      const Eigen::Vector3d share((i + 0.5) / kSteps, (j + 0.5) / kSteps, 0);
      if (share.norm() > 1) continue;
      const Eigen::Vector3d p = centre + kDiameter / 2 * share;
      const NodalWeights there =
          ShapeFunctions(surface_, ClosestSurfacePoint(surface_, sheet_.nodes, p).at);
      for (std::size_t k = 0; k < there.nodes.size(); ++k) fine(there.nodes[k]) += there.weights[k];
      ++count;
    }
  }
  fine /= count;
  for (std::size_t k = 0; k < patch.nodes.size(); ++k) fine(patch.nodes[k]) -= patch.weights[k];

  EXPECT_LT(fine.lpNorm<Eigen::Infinity>(), 1e-3);  // the jagged rim of the fine sum
}

TEST_P(PatchOfOrder, SlopesAreTheDifferencesOfWeights) {
  const Eigen::Vector3d at(0.0171, 0.0233, 0.002);
  Eigen::Matrix3Xd directions(3, 2);
  directions << 1, 0.6, 0, 0.8, 0, 0;
  const double h = 1e-5;  // m
  for (const double diameter : {0.0, kDiameter}) {
    const SurfacePoint centre = ClosestSurfacePoint(surface_, sheet_.nodes, at).at;
    const MovingPatch moving = Patches(surface_, sheet_.nodes, diameter).At(centre, directions);
    for (int k = 0; k < 2; ++k) {
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(sheet_.num_nodes());
      const NodalWeights ahead = PatchAt(at + h * directions.col(k), diameter);
      const NodalWeights behind = PatchAt(at - h * directions.col(k), diameter);
      for (size_t i = 0; i < ahead.nodes.size(); ++i) {
        slope(ahead.nodes[i]) += ahead.weights[i] / (2 * h);
      }
      for (size_t i = 0; i < behind.nodes.size(); ++i) {
        slope(behind.nodes[i]) -= behind.weights[i] / (2 * h);
      }
      for (size_t i = 0; i < moving.weights.nodes.size(); ++i) {
        slope(moving.weights.nodes[i]) -= moving.slopes(static_cast<int>(i), k);
      }
      // 1/m, of slopes of up to 230: points of the disc that cross an edge within 2h.
      EXPECT_LT(slope.cwiseAbs().maxCoeff(), diameter > 0 ? 3 : 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothOrders, PatchOfOrder, ::testing::Values(1, 2));

TEST(PatchWeights, HaveTheSecondMomentOfADisc) {
  const TetMesh sheet = RaiseOrder(testing::MakeBox(9, 9, 1, {0.04, 0.04, 0.002}));
  const Surface surface = ExtractSurface(sheet);
  const Eigen::Vector3d centre(0.0171, 0.0233, 0.002);
  const SurfacePoint at = ClosestSurfacePoint(surface, sheet.nodes, centre).at;

  const NodalWeights patch = PatchWeights(surface, sheet.nodes, at, kDiameter);

  const Eigen::Matrix3Xd squares = (sheet.nodes.colwise() - centre).array().square();
  const double expected = kDiameter * kDiameter / 16;  // R²/4
  EXPECT_NEAR(patch.Apply(squares).x(), expected, 0.01 * expected);
  EXPECT_NEAR(patch.Apply(squares).y(), expected, 0.01 * expected);
}

}  // namespace
}  // namespace softforce::mesh
