#include "softforce/mesh/mesh_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "softforce/mesh/surface_groups.h"
#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

using softforce::testing::MakeBox;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kRounding = 1e-12;  // of values about 1

TetMesh OneTetrahedron(const Eigen::Matrix<double, 3, 4>& corners) {
  TetMesh mesh;
  mesh.nodes = corners;
  mesh.elements = Eigen::Vector4i(0, 1, 2, 3);
  mesh.region = {0};
  mesh.region_names = {""};
  return mesh;
}

TetMesh Regular(double edge) {
  Eigen::Matrix<double, 3, 4> corners;
  corners << 0, 1, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1;
  return OneTetrahedron(corners * edge / std::sqrt(2));
}

// The corner that three edges of a cube cut off.
TetMesh CubeCorner(double edge, double height) {
  Eigen::Matrix<double, 3, 4> corners;
  corners << 0, edge, 0, 0, 0, 0, edge, 0, 0, 0, 0, height;
  return OneTetrahedron(corners);
}

// Two meshes as one, no node shared.
TetMesh Together(TetMesh a, const TetMesh& b) {
  const int shift = a.num_nodes(), elements = a.num_elements();
  a.nodes.conservativeResize(3, shift + b.num_nodes());
  a.nodes.rightCols(b.num_nodes()) = b.nodes;
  a.elements.conservativeResize(Eigen::NoChange, elements + b.num_elements());
  a.elements.rightCols(b.num_elements()) = b.elements.array() + shift;
  a.region.insert(a.region.end(), b.region.begin(), b.region.end());
  return a;
}

TetMesh Moved(TetMesh mesh, const Eigen::Vector3d& by) {
  mesh.nodes.colwise() += by;
  return mesh;
}

TEST(MeshReport, WarnsOfPartsThatFillTheSameSpace) {
  const TetMesh box = MakeBox(3, 3, 3, {0.03, 0.03, 0.03});
  const MeshReport overlapping = ExamineMesh(Together(box, Moved(box, {0.015, 0, 0})));
  const MeshReport beside = ExamineMesh(Together(box, Moved(box, {0.03, 0, 0})));

  EXPECT_GT(overlapping.overlapping_cells, box.num_elements() / 2);
  EXPECT_THAT(overlapping.warnings, Contains(HasSubstr("fill the same space")));
  EXPECT_EQ(beside.overlapping_cells, 0);
}

TEST(MeshReport, GivesTheRegularTetrahedronQualityOneAtAnySize) {
  for (const double edge : {1e-3, 0.1}) {
    const MeshReport report = ExamineMesh(Regular(edge));

    EXPECT_NEAR(report.least_quality.value, 1, kRounding);
    EXPECT_NEAR(report.least_dihedral, std::acos(1.0 / 3), kRounding);
    EXPECT_NEAR(report.greatest_dihedral, std::acos(1.0 / 3), kRounding);
    EXPECT_NEAR(report.median_edge / edge, 1, kRounding);
    EXPECT_NEAR(report.volume / (edge * edge * edge), std::sqrt(2) / 12, kRounding);
  }
}

TEST(MeshReport, GivesTheCornerOfACubeItsKnownShape) {
  const MeshReport report = ExamineMesh(CubeCorner(0.02, 0.02));

  // V = a³/6 and Σ l² = 3 a² + 3 · 2 a², so 12 (a³/2)^(2/3) / (9 a²) = 4/3 · 2^(-2/3).
  EXPECT_NEAR(report.least_quality.value, 4.0 / 3 / std::cbrt(4), kRounding);
  EXPECT_NEAR(report.greatest_dihedral, std::acos(0.0), kRounding);
  EXPECT_NEAR(report.least_dihedral, std::acos(1 / std::sqrt(3)), kRounding);
}

TEST(MeshReport, WarnsOfFlatCellsAndSaysWhere) {
  const MeshReport report =
      ExamineMesh(Together(Moved(Regular(0.02), {0.1, 0, 0}), CubeCorner(0.02, 0.0002)));

  EXPECT_EQ(report.poor_elements, 1);
  EXPECT_LT(report.least_quality.value, kPoorQuality);
  EXPECT_NEAR(report.least_quality.at.x(), 0.005, kRounding);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("quality below 0.1")));
}

TEST(MeshReport, OfACleanBoxHasNoWarning) {
  const MeshReport report = ExamineMesh(MakeBox(4, 4, 4, {0.04, 0.04, 0.04}));

  EXPECT_THAT(report.warnings, IsEmpty());
  EXPECT_EQ(report.parts, 1);
  EXPECT_EQ(report.cavities, 0);
  EXPECT_NEAR(1e6 * report.volume, 64, 1e-9);  // cm³; rounding
}

TEST(MeshReport, CountsCellsBetweenOppositeWalls) {
  for (const int layers : {1, 2, 3}) {
    const MeshReport report = ExamineMesh(MakeBox(12, 12, layers, {0.12, 0.12, 0.01 * layers}));
    const double share[] = {report.one_cell_thick, report.two_cells_thick, report.more_cells_thick};

    // The four sides have 12 cells to the opposite one: 0.4 to 0.5 of the area at most.
    EXPECT_GT(share[layers - 1], 0.6) << layers;
    EXPECT_NEAR(share[0] + share[1] + share[2], 1, kRounding);
    EXPECT_NEAR(report.thinnest.value, 0.01 * layers, 1e-9);  // m; rounding
  }
}

TEST(MeshReport, WarnsOfPartsThatTouchWithoutSharingNodes) {
  const TetMesh box = MakeBox(2, 2, 2, {0.02, 0.02, 0.02});

  const MeshReport report = ExamineMesh(Together(box, Moved(box, {0.02, 0, 0})));

  EXPECT_EQ(report.parts, 2);
  EXPECT_EQ(report.coincident_nodes, 9);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("are not joined")));
}

TEST(MeshReport, WarnsOfPartsThatHangTogetherByANode) {
  TetMesh mesh = MakeBox(1, 1, 1, {0.02, 0.02, 0.02});  // node 7 is the corner at 20 20 20 mm
  const TetMesh other = CubeCorner(0.02, 0.02);
  const int first = mesh.num_nodes();
  mesh.nodes.conservativeResize(3, first + 3);
  mesh.nodes.rightCols(3) = other.nodes.rightCols(3).colwise() + mesh.nodes.col(7).eval();
  mesh.elements.conservativeResize(4, mesh.num_elements() + 1);
  mesh.elements.rightCols(1) = Eigen::Vector4i(7, first, first + 1, first + 2);
  mesh.region.push_back(0);

  const MeshReport report = ExamineMesh(mesh);

  EXPECT_EQ(report.parts, 1);
  EXPECT_EQ(report.parts_by_faces, 2);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("hinge")));
}

TEST(MeshReport, MeasuresGroups) {
  const TetMesh box = WithSurfaceGroups(MakeBox(2, 2, 2, {0.01, 0.02, 0.03}), {"all=outer"}, "box");
  const MeshReport report = ExamineMesh(box);

  ASSERT_EQ(report.groups.size(), 3u);
  const SurfaceGroupReport &all = report.groups[0], &bottom = report.groups[1];
  EXPECT_EQ(all.name, "all");
  EXPECT_TRUE(all.closed);
  EXPECT_NEAR(1e6 * all.enclosed_volume, 6, 1e-9);  // cm³; rounding
  EXPECT_NEAR(1e6 * all.area, 2200, 1e-6);          // mm²; rounding
  EXPECT_FALSE(bottom.closed);
  EXPECT_NEAR(1e6 * bottom.area, 200, 1e-6);  // mm²; rounding
  EXPECT_NEAR(bottom.centre.z(), 0, kRounding);
}

TEST(MeshReport, WarnsOfGroupsWithinTheBody) {
  TetMesh box = MakeBox(1, 1, 1, {0.02, 0.02, 0.02});
  box.surface_groups["inside"] = {{0, 3, 7}};  // the brick's diagonal plane

  const MeshReport report = ExamineMesh(box);

  EXPECT_THAT(report.warnings, Contains(HasSubstr("\"inside\": 1 of its 1 triangles")));
}

TEST(MeshReport, OfStraightTenNodeCellsHasAnEvenJacobian) {
  const MeshReport report = ExamineMesh(RaiseOrder(MakeBox(2, 2, 2, {0.02, 0.03, 0.04})));

  EXPECT_EQ(report.order, 2);
  EXPECT_NEAR(report.least_jacobian_ratio.value, 1, 1e-9);  // rounding, of volumes
}

TEST(MeshReport, WarnsOfStronglyCurvedCells) {
  TetMesh curved = RaiseOrder(Regular(0.02));
  curved.nodes.col(4) += 0.2 * (curved.nodes.col(1) - curved.nodes.col(0));  // along edge 01

  const MeshReport report = ExamineMesh(curved);

  // The Jacobian along a straight edge with its middle node at the share 1/2 + d is 1 ∓ 4 d at its
  // ends: (1 − 0.8) / (1 + 0.8).
  EXPECT_NEAR(report.least_jacobian_ratio.value, 0.2 / 1.8, 1e-9);  // rounding
  EXPECT_THAT(report.warnings, Contains(HasSubstr("Jacobian")));
}

TEST(MeshReport, WarnsOfAnUnlikelySize) {
  EXPECT_THAT(ExamineMesh(MakeBox(4, 4, 4, {40, 40, 40})).warnings, Contains(HasSubstr("--unit")));
}

TEST(MeshReport, WarnsIfTheGeometryLostVolume) {
  const TetMesh box = MakeBox(4, 4, 4, {0.04, 0.04, 0.04});

  EXPECT_THAT(ExamineMesh(box, 70e-6).warnings, Contains(HasSubstr("91.4 %")));
  EXPECT_THAT(ExamineMesh(box, 64.1e-6).warnings, IsEmpty());
}

TEST(MeshReport, PrintsATable) {
  const std::string text = ExamineMesh(MakeBox(4, 4, 4, {0.04, 0.04, 0.04})).FullReport();

  for (const char* words : {"384 cells of 4 nodes", "40.00 x 40.00 x 40.00 mm", "64 cm^3",
                            "connected parts", "(unnamed)", "bottom", "1600.00"}) {
    EXPECT_THAT(text, HasSubstr(words));
  }
}

}  // namespace
}  // namespace softforce::mesh
