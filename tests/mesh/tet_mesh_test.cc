#include "softforce/mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

double CornerVolume(const TetMesh& mesh) {
  double sum = 0;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const auto X = [&](int i) -> Eigen::Vector3d { return mesh.nodes.col(mesh.elements(i, e)); };
    sum += (X(1) - X(0)).cross(X(2) - X(0)).dot(X(3) - X(0)) / 6;
  }
  return sum;
}

TEST(MakeBox, FillsItsVolume) {
  EXPECT_NEAR(CornerVolume(testing::MakeBox(2, 3, 4, {0.2, 0.3, 0.4})), 0.024, 1e-15);
}

TEST(RaiseOrder, KeepsTheCornersAndTheVolume) {
  const TetMesh box = testing::MakeBox(2, 1, 3, {0.2, 0.1, 0.3});

  const TetMesh raised = RaiseOrder(box);

  ASSERT_EQ(raised.order(), 2);
  EXPECT_EQ(raised.elements.topRows(4), box.elements);
  EXPECT_EQ(raised.nodes.leftCols(box.num_nodes()), box.nodes);
  EXPECT_EQ(CornerVolume(raised), CornerVolume(box));
}

TEST(RaiseOrder, PutsNodesInTheMiddleOfEdges) {
  const TetMesh raised = RaiseOrder(testing::MakeBox(2, 2, 2, {0.1, 0.2, 0.3}));

  for (int e = 0; e < raised.num_elements(); ++e) {
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d a = raised.nodes.col(raised.elements(kEdges[i][0], e));
      const Eigen::Vector3d b = raised.nodes.col(raised.elements(kEdges[i][1], e));
      EXPECT_EQ(raised.nodes.col(raised.elements(4 + i, e)), (a + b) / 2);
    }
  }
}

TEST(RaiseOrder, AddsOneNodePerEdgeOfTheMesh) {
  const TetMesh box = testing::MakeBox(3, 2, 2, {1, 1, 1});
  std::set<std::pair<int, int>> edges;
  for (int e = 0; e < box.num_elements(); ++e) {
    for (const auto& [i, j] : kEdges) {
      edges.insert(std::minmax({box.elements(i, e), box.elements(j, e)}));
    }
  }

  const TetMesh raised = RaiseOrder(box);

  EXPECT_EQ(raised.num_nodes(), box.num_nodes() + static_cast<int>(edges.size()));
}

TEST(RaiseOrder, LeavesTenNodeElementsAsTheyAre) {
  TetMesh curved = RaiseOrder(testing::MakeBox(1, 1, 1, {1, 1, 1}));
  curved.nodes(0, curved.num_nodes() - 1) += 0.01;

  const TetMesh again = RaiseOrder(curved);

  EXPECT_EQ(again.nodes, curved.nodes);
  EXPECT_EQ(again.elements, curved.elements);
}

TEST(LowerOrder, UndoesRaiseOrder) {
  const TetMesh box = testing::MakeBox(2, 3, 1, {0.2, 0.3, 0.1});

  const TetMesh lowered = LowerOrder(RaiseOrder(box));

  EXPECT_EQ(lowered.nodes, box.nodes);
  EXPECT_EQ(lowered.elements, box.elements);
  EXPECT_EQ(lowered.region, box.region);
  EXPECT_EQ(lowered.region_names, box.region_names);
  EXPECT_EQ(lowered.surface_groups, box.surface_groups);
}

TEST(LowerOrder, RenumbersWhereMiddleNodesComeFirst) {
  const TetMesh box = testing::MakeBox(1, 2, 1, {0.1, 0.2, 0.1});
  TetMesh reversed = RaiseOrder(box);  // node n becomes node N − 1 − n
  const int last = reversed.num_nodes() - 1;
  reversed.nodes = reversed.nodes.rowwise().reverse().eval();
  reversed.elements = last - reversed.elements.array();
  for (auto& [name, triangles] : reversed.surface_groups) {
    for (auto& triangle : triangles) {
      for (int& node : triangle) node = last - node;
    }
  }

  const TetMesh lowered = LowerOrder(reversed);

  ASSERT_EQ(lowered.num_nodes(), box.num_nodes());
  EXPECT_EQ(lowered.nodes, box.nodes.rowwise().reverse());
  EXPECT_TRUE((lowered.elements.array() == box.num_nodes() - 1 - box.elements.array()).all());
  EXPECT_EQ(lowered.surface_groups.at("top")[0][0],
            box.num_nodes() - 1 - box.surface_groups.at("top")[0][0]);
}

}  // namespace
}  // namespace softforce::mesh
