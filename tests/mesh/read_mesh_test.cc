#include "softforce/mesh/read_mesh.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <clocale>

#include "mesh/mesh_files.h"
#include "softforce/mesh/write_vtu.h"

namespace softforce::mesh {
namespace {

using softforce::testing::FreshFolder;
using softforce::testing::MakeTwoRegionBox;
using softforce::testing::WriteGmsh;
using softforce::testing::WriteText;

void ExpectSameCells(const TetMesh& read, const TetMesh& expected) {
  ASSERT_EQ(read.num_nodes(), expected.num_nodes());
  EXPECT_LT((read.nodes - expected.nodes).cwiseAbs().maxCoeff(), 1e-15);  // m; 16 digits in mm
  EXPECT_EQ(read.elements, expected.elements);
  EXPECT_EQ(read.region, expected.region);
}

class ReadGmshFormat : public ::testing::TestWithParam<std::tuple<double, bool, int>> {};

TEST_P(ReadGmshFormat, GivesTheMeshThatWasWritten) {
  const auto [version, binary, order] = GetParam();
  const TetMesh box = MakeTwoRegionBox(order);
  const auto path = FreshFolder() / "box.msh";
  WriteGmsh(path, box, {version, binary});

  const TetMesh read = ReadMesh(path, 1e-3);

  ExpectSameCells(read, box);
  EXPECT_EQ(read.region_names, box.region_names);
  EXPECT_EQ(read.surface_groups, box.surface_groups);
}

INSTANTIATE_TEST_SUITE_P(All, ReadGmshFormat,
                         ::testing::Combine(::testing::Values(2.2, 4.1), ::testing::Bool(),
                                            ::testing::Values(1, 2)));

class ReadOfOrder : public ::testing::TestWithParam<int> {};

TEST_P(ReadOfOrder, LegacyVtkGivesTheMeshThatWasWritten) {
  const TetMesh box = MakeTwoRegionBox(GetParam());
  const auto path = WriteText(FreshFolder() / "box.vtk", softforce::testing::LegacyVtk(box));

  const TetMesh read = ReadMesh(path, 1e-3);

  ExpectSameCells(read, box);
  EXPECT_EQ(read.region_names, (std::vector<std::string>{"1", "2"}));
}

TEST_P(ReadOfOrder, VtuGivesTheMeshThatWasWritten) {
  const TetMesh box = MakeTwoRegionBox(GetParam());
  const auto path = FreshFolder() / "box.vtu";
  WriteVtu(path, box);

  const TetMesh read = ReadMesh(path, 1);

  ExpectSameCells(read, box);
  EXPECT_EQ(read.region_names, (std::vector<std::string>{"1", "2"}));
}

INSTANTIATE_TEST_SUITE_P(BothOrders, ReadOfOrder, ::testing::Values(1, 2));

// Two tetrahedra without any physical group, as Gmsh writes them, with gaps between the tags.
constexpr char kUngrouped[] = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
50 0 0 -1
$EndNodes
$Elements
2
7 4 2 0 1 10 20 30 40
9 4 2 0 1 10 30 20 50
$EndElements
)";

TEST(ReadMesh, PutsElementsWithoutAPhysicalGroupIntoTheUnnamedRegion) {
  const TetMesh mesh = ReadMesh(WriteText(FreshFolder() / "two.msh", kUngrouped), 1);

  EXPECT_EQ(mesh.num_elements(), 2);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{""});
}

TEST(ReadMesh, NumbersNodesInTheOrderOfTheirTags) {
  const TetMesh mesh = ReadMesh(WriteText(FreshFolder() / "two.msh", kUngrouped), 1);

  EXPECT_EQ(mesh.elements.col(1), Eigen::Vector4i(0, 2, 1, 4));
}

TEST(ReadMesh, KeepsNodesThatNoElementUses) {
  TetMesh box = MakeTwoRegionBox(1);
  box.nodes.conservativeResize(3, box.num_nodes() + 1);
  box.nodes.rightCols<1>().setConstant(0.5);
  const auto folder = FreshFolder();
  WriteText(folder / "box.vtk", softforce::testing::LegacyVtk(box));
  WriteGmsh(folder / "box.msh", box, {4.1, false});

  EXPECT_EQ(ReadMesh(folder / "box.vtk", 1e-3).num_nodes(), box.num_nodes());
  EXPECT_EQ(ReadMesh(folder / "box.msh", 1e-3).num_nodes(), box.num_nodes());
}

TEST(ReadMesh, PrintsNothing) {
  const auto folder = FreshFolder();
  WriteGmsh(folder / "box.msh", MakeTwoRegionBox(1), {4.1, false});
  WriteVtu(folder / "box.vtu", MakeTwoRegionBox(1));

  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  ReadMesh(folder / "box.msh", 1e-3);
  ReadMesh(folder / "box.vtu", 1);

  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ReadMesh, LeavesTheNumberOfThreadsAsItIs) {
  const auto path = WriteText(FreshFolder() / "two.msh", kUngrouped);
  const int before = omp_get_max_threads();
  omp_set_num_threads(3);

  ReadMesh(path, 1);

  EXPECT_EQ(omp_get_max_threads(), 3);
  omp_set_num_threads(before);
}

TEST(ReadMesh, LeavesTheLocaleAsItIs) {
  const auto path = WriteText(FreshFolder() / "two.msh", kUngrouped);
  if (std::setlocale(LC_ALL, "C.UTF-8") == nullptr) GTEST_SKIP() << "no locale C.UTF-8";

  ReadMesh(path, 1);

  EXPECT_STREQ(std::setlocale(LC_NUMERIC, nullptr), "C.UTF-8");
}

}  // namespace
}  // namespace softforce::mesh
