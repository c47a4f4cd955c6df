#include "softforce/mesh/refine.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "softforce/base/input_error.h"
#include "softforce/mesh/surface.h"
#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

Eigen::Matrix<double, 3, 4> CornersOf(const TetMesh& mesh, int e) {
  Eigen::Matrix<double, 3, 4> corners;
  for (int i = 0; i < 4; ++i) corners.col(i) = mesh.nodes.col(mesh.elements(i, e));
  return corners;
}

double CellVolume(const Eigen::Matrix<double, 3, 4>& X) {
  return (X.col(1) - X.col(0)).cross(X.col(2) - X.col(0)).dot(X.col(3) - X.col(0)) / 6;
}

double Volume(const TetMesh& mesh) {
  double sum = 0;
  for (int e = 0; e < mesh.num_elements(); ++e) sum += CellVolume(CornersOf(mesh, e));
  return sum;
}

// Volume over the cube of the root mean square edge; 1 for a regular tetrahedron.
double WorstShape(const TetMesh& mesh) {
  double worst = 1;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const Eigen::Matrix<double, 3, 4> X = CornersOf(mesh, e);
    double squares = 0;
    for (const auto& [i, j] : kEdges) squares += (X.col(i) - X.col(j)).squaredNorm() / 6;
    worst = std::min(worst, 6 * std::sqrt(2.0) * CellVolume(X) / std::pow(squares, 1.5));
  }
  return worst;
}

// Area of the boundary by its corners. Hanging nodes leave faces inside the body without partner,
// and so add to it.
double SurfaceArea(const TetMesh& mesh) {
  const Surface surface = ExtractSurface(mesh);
  double sum = 0;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const Eigen::Vector3d a = mesh.nodes.col(surface.triangles(0, t));
    const Eigen::Vector3d b = mesh.nodes.col(surface.triangles(1, t));
    const Eigen::Vector3d c = mesh.nodes.col(surface.triangles(2, t));
    sum += (b - a).cross(c - a).norm() / 2;
  }
  return sum;
}

// A box whose middle nodes stand off the straight edges, and its cells in two regions.
TetMesh CurvedBox() {
  TetMesh box = testing::MakeBox(3, 2, 2, {0.03, 0.02, 0.02});
  box.region_names = {"left", "right"};
  for (int e = 0; e < box.num_elements(); ++e) {
    box.region[e] = CornersOf(box, e).row(0).mean() > 0.01 ? 1 : 0;
  }
  TetMesh curved = RaiseOrder(box);
  for (int node = 0; node < curved.num_nodes(); ++node) {
    curved.nodes(2, node) += 2 * curved.nodes(0, node) * curved.nodes(0, node);  // 2/m · x²
  }
  return curved;
}

TEST(Refine, CutsEachCellInEightThatFillTheSameSpace) {
  const TetMesh box = testing::MakeBox(3, 2, 1, {0.3, 0.1, 0.2});

  const Refinement fine = Refine(box);

  EXPECT_EQ(fine.mesh.num_elements(), 8 * box.num_elements());
  EXPECT_NO_THROW(CheckMesh(fine.mesh, "refined"));    // none inverted, none unused
  EXPECT_NEAR(Volume(fine.mesh), Volume(box), 1e-15);  // m³, rounding
}

TEST(Refine, StaysConforming) {
  const TetMesh box = testing::MakeBox(2, 3, 2, {0.1, 0.2, 0.3});

  const TetMesh fine = Refine(box).mesh;

  EXPECT_EQ(ExtractSurface(fine).num_triangles(), 4 * ExtractSurface(box).num_triangles());
  EXPECT_NEAR(SurfaceArea(fine), SurfaceArea(box), 1e-14);  // m², rounding
}

TEST(Refine, GivesPartsTheRegionAndTheVolumeOfTheirParent) {
  const TetMesh coarse = LowerOrder(CurvedBox());

  const Refinement fine = Refine(coarse);

  EXPECT_EQ(fine.mesh.region_names, coarse.region_names);
  std::vector<double> volume(coarse.num_elements(), 0);
  for (int e = 0; e < fine.mesh.num_elements(); ++e) {
    EXPECT_EQ(fine.mesh.region[e], coarse.region[fine.parent[e]]);
    volume[fine.parent[e]] += CellVolume(CornersOf(fine.mesh, e));
  }
  for (int e = 0; e < coarse.num_elements(); ++e) {
    EXPECT_NEAR(volume[e], CellVolume(CornersOf(coarse, e)), 1e-18);  // m³, rounding
  }
}

TEST(Refine, CutsSurfaceGroupsWithTheirCells) {
  const TetMesh box = testing::MakeBox(2, 3, 2, {0.1, 0.2, 0.3});

  const TetMesh fine = Refine(box).mesh;

  ASSERT_EQ(fine.surface_groups.at("top").size(), 4 * box.surface_groups.at("top").size());
  std::set<std::array<int, 3>> triangles;
  for (std::array<int, 3> triangle : fine.surface_groups.at("top")) {
    for (const int node : triangle) EXPECT_DOUBLE_EQ(fine.nodes(2, node), 0.3);
    std::sort(triangle.begin(), triangle.end());
    triangles.insert(triangle);
  }
  EXPECT_EQ(triangles.size(), fine.surface_groups.at("top").size());
}

TEST(Refine, KeepsTheCurvedShapeOfTenNodeCells) {
  const TetMesh curved = CurvedBox();

  const TetMesh fine = Refine(curved).mesh;

  ASSERT_EQ(fine.order(), 2);
  EXPECT_NO_THROW(CheckMesh(fine, "refined"));
  // The top was bent to z = 0.02 + 2 x², which quadratic edges follow exactly.
  const Surface surface = ExtractSurface(fine);
  int on_top = 0;
  for (const int node : surface.triangles.reshaped()) {
    const double x = fine.nodes(0, node), z = fine.nodes(2, node);
    if (z < 0.0199 + 2 * x * x) continue;
    ++on_top;
    EXPECT_NEAR(z, 0.02 + 2 * x * x, 1e-16);  // m, rounding
  }
  EXPECT_GT(on_top, 0);
}

TEST(Refine, DoesNotSpoilTheShapesOfTheCells) {
  TetMesh mesh = testing::MakeBox(2, 2, 2, {0.1, 0.12, 0.07});
  const double before = WorstShape(mesh);
  for (int i = 0; i < 3; ++i) mesh = Refine(mesh).mesh;
  // Parts of a tetrahedron fall into at most three classes of shape under a fixed diagonal (Bey
  // 1995); the worst of them is some two thirds as good.
  EXPECT_GT(WorstShape(mesh), 0.6 * before);
}

TEST(RefineWhere, LeavesAMeshAloneWithoutMarks) {
  const TetMesh box = CurvedBox();
  const Refinement same = RefineWhere(box, std::vector<char>(box.num_elements(), false));
  EXPECT_EQ(same.mesh.num_elements(), box.num_elements());
  EXPECT_EQ(same.mesh.num_nodes(), box.num_nodes());
}

TEST(RefineWhere, CutsMarkedCellsInEightAndKeepsFarOnesWhole) {
  const TetMesh box = testing::MakeBox(20, 2, 2, {0.2, 0.02, 0.02});
  std::vector<char> marked(box.num_elements(), false);
  marked[0] = true;  // at x = 0

  const Refinement fine = RefineWhere(box, marked);

  EXPECT_EQ(std::count(fine.parent.begin(), fine.parent.end(), 0), 8);
  EXPECT_EQ(std::count(fine.parent.begin(), fine.parent.end(), box.num_elements() - 1), 1);
}

// Conforming, of the same volume, and still well shaped when refined six times into a corner.
TEST(RefineWhere, CanBeRepeated) {
  const TetMesh box = testing::MakeBox(4, 4, 4, {0.1, 0.1, 0.1});
  TetMesh mesh = box;
  for (int round = 0; round < 6; ++round) {
    std::vector<char> marked(mesh.num_elements(), false);
    for (int e = 0; e < mesh.num_elements(); ++e) {
      marked[e] = CornersOf(mesh, e).colwise().norm().minCoeff() < 1e-9;  // touches the origin
    }
    mesh = RefineWhere(mesh, marked).mesh;
  }

  EXPECT_NO_THROW(CheckMesh(mesh, "refined"));
  EXPECT_NEAR(Volume(mesh), Volume(box), 1e-15);            // m³, rounding
  EXPECT_NEAR(SurfaceArea(mesh), SurfaceArea(box), 1e-13);  // m², rounding
  EXPECT_GT(WorstShape(mesh), 0.4 * WorstShape(box));       // bisection adds a few classes
  double smallest = 1;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    smallest = std::min(smallest, CellVolume(CornersOf(mesh, e)));
  }
  EXPECT_LT(smallest, 1e-4 * CellVolume(CornersOf(box, 0)));  // six times 8 is 4e-6
}

TEST(RefineWhere, RefusesFlagsOfAnotherMesh) {
  EXPECT_THROW(RefineWhere(testing::MakeBox(1, 1, 1, {1, 1, 1}), {1}), base::InputError);
}

}  // namespace
}  // namespace softforce::mesh
