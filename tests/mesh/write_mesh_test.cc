#include "softforce/mesh/write_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/mesh_files.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"

namespace softforce::mesh {
namespace {

using softforce::testing::FreshFolder;
using softforce::testing::MakeTwoRegionBox;
using softforce::testing::ReadText;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class WriteMeshOfOrder : public ::testing::TestWithParam<int> {};

TEST_P(WriteMeshOfOrder, AsGmshIsReadBackIdentical) {
  TetMesh box = MakeTwoRegionBox(GetParam());
  const auto path = FreshFolder() / "box.msh";
  // What stands in a file in millimetres; a metre's digits may not survive the division.
  box.nodes = (1e3 * box.nodes).eval() * 1e-3;

  WriteMesh(path, box, 1e-3);
  const TetMesh read = ReadMesh(path, 1e-3);

  EXPECT_EQ(read.nodes, box.nodes);
  EXPECT_EQ(read.elements, box.elements);
  EXPECT_EQ(read.region, box.region);
  EXPECT_EQ(read.region_names, box.region_names);
  EXPECT_EQ(read.surface_groups, box.surface_groups);
}

TEST_P(WriteMeshOfOrder, KeepsTrianglesThatAreInTwoGroups) {
  TetMesh box = MakeTwoRegionBox(GetParam());
  const auto& top = box.surface_groups.at("top");
  box.surface_groups["held"] = {top[1], box.surface_groups.at("bottom")[2], top[4]};
  const auto path = FreshFolder() / "box.msh";

  WriteMesh(path, box, 1e-3);
  const TetMesh read = ReadMesh(path, 1e-3);

  ASSERT_EQ(read.surface_groups.size(), 3u);
  for (const auto& [name, triangles] : box.surface_groups) {
    EXPECT_THAT(read.surface_groups.at(name), ::testing::UnorderedElementsAreArray(triangles));
  }
}

TEST_P(WriteMeshOfOrder, WritesEachTriangleOnceForGmsh) {
  TetMesh box = MakeTwoRegionBox(GetParam());
  box.surface_groups["held"] = box.surface_groups.at("top");
  const auto path = FreshFolder() / "box.msh";
  WriteMesh(path, box, 1e-3);

  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(path.string());
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, 2);
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  gmsh::finalize();

  ASSERT_EQ(types.size(), 1u);
  EXPECT_EQ(types[0], GetParam() == 2 ? 9 : 2);
  EXPECT_EQ(tags[0].size(),
            box.surface_groups.at("top").size() + box.surface_groups.at("bottom").size());
  EXPECT_EQ(groups.size(), 5u);  // three of surfaces, two of volumes
}

TEST_P(WriteMeshOfOrder, AsVtkKeepsCellsAndRegions) {
  const TetMesh box = MakeTwoRegionBox(GetParam());
  for (const char* name : {"box.vtk", "box.vtu"}) {
    const auto path = FreshFolder() / name;

    WriteMesh(path, box, 1e-3);
    const TetMesh read = ReadMesh(path, 1e-3);

    EXPECT_LT((read.nodes - box.nodes).cwiseAbs().maxCoeff(), 1e-16) << name;  // m; rounding
    EXPECT_EQ(read.elements, box.elements) << name;
    EXPECT_EQ(read.region, box.region) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(BothOrders, WriteMeshOfOrder, ::testing::Values(1, 2));

TEST(WriteMesh, ConvertsBetweenUnits) {
  const TetMesh box = MakeTwoRegionBox(1);
  const auto path = FreshFolder() / "box.msh";

  WriteMesh(path, box, 1e-2);

  EXPECT_NEAR(ReadMesh(path, 1).nodes.maxCoeff(), 3, 1e-12);  // 30 mm in centimetres; rounding
}

TEST(WriteMesh, LeavesARegionWithoutANameUnnamed) {
  const TetMesh box = softforce::testing::MakeBox(1, 1, 1, {1, 1, 1});
  const auto path = FreshFolder() / "box.msh";

  WriteMesh(path, box, 1);

  EXPECT_EQ(ReadMesh(path, 1).region_names, std::vector<std::string>{""});
}

TEST(WriteMesh, GivesTheSameBytesForTheSameMesh) {
  const auto folder = FreshFolder();
  for (const std::string extension : {".msh", ".vtk"}) {
    WriteMesh(folder / ("one" + extension), MakeTwoRegionBox(2), 1e-3);
    WriteMesh(folder / ("other" + extension), MakeTwoRegionBox(2), 1e-3);

    EXPECT_EQ(ReadText(folder / ("one" + extension)), ReadText(folder / ("other" + extension)));
  }
}

TEST(WriteMesh, RefusesAnotherExtension) {
  EXPECT_THAT([] { WriteMesh("box.stl", MakeTwoRegionBox(1), 1); },
              ThrowsMessage<base::InputError>(HasSubstr("must be .msh")));
}

TEST(WriteMesh, RefusesAFolderThatDoesNotExist) {
  const auto folder = FreshFolder() / "none";
  for (const char* name : {"box.msh", "box.vtk"}) {
    EXPECT_THAT([&] { WriteMesh(folder / name, MakeTwoRegionBox(1), 1); },
                ThrowsMessage<base::InputError>(HasSubstr("cannot be written")));
  }
}

TEST(WriteMesh, RefusesGroupsThatAreNotFacesAndLeavesNothing) {
  TetMesh box = MakeTwoRegionBox(2);
  box.surface_groups["wrong"] = {{0, 5, box.elements.topRows(4).maxCoeff()}};
  const auto folder = FreshFolder();

  EXPECT_THAT([&] { WriteMesh(folder / "box.msh", box, 1); },
              ThrowsMessage<base::InputError>(HasSubstr("not the corners of a face")));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace softforce::mesh
