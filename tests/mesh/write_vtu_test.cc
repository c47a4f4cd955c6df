#include "softforce/mesh/write_vtu.h"

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

TEST(WriteVtu, NamesTheFieldsAtTheNodes) {
  const TetMesh box = MakeTwoRegionBox(2);
  const auto path = FreshFolder() / "box.vtu";

  WriteVtu(path, box, {{"displacement_m", Eigen::Matrix3Xd::Ones(3, box.num_nodes())}});

  EXPECT_THAT(ReadText(path), ::testing::HasSubstr("Name=\"displacement_m\""));
}

TEST(WriteVtu, TakesNumbersAtTheNodesToo) {
  const TetMesh box = MakeTwoRegionBox(1);
  const auto path = FreshFolder() / "box.vtu";

  WriteVtu(path, box, {{"von_mises_Pa", Eigen::RowVectorXd::Ones(box.num_nodes())}});

  EXPECT_THAT(ReadText(path), ::testing::HasSubstr("Name=\"von_mises_Pa\""));
  EXPECT_THAT(ReadText(path), ::testing::Not(::testing::ContainsRegex(
                                  "Name=\"von_mises_Pa\"[^>]*NumberOfComponents=\"3\"")));
}

TEST(WritePointsVtu, WritesPointsOrNone) {
  const auto folder = FreshFolder();

  WritePointsVtu(folder / "two.vtu", Eigen::Matrix3Xd::Ones(3, 2),
                 {{"force_N", Eigen::Matrix3Xd::Ones(3, 2)}});
  WritePointsVtu(folder / "none.vtu", Eigen::Matrix3Xd(3, 0),
                 {{"force_N", Eigen::Matrix3Xd(3, 0)}});

  EXPECT_THAT(ReadText(folder / "two.vtu"), ::testing::HasSubstr("NumberOfPoints=\"2\""));
  EXPECT_THAT(ReadText(folder / "none.vtu"), ::testing::HasSubstr("NumberOfPoints=\"0\""));
}

TEST(WriteVtu, KeepsRegionsThatAreNamedByNumbers) {
  TetMesh box = MakeTwoRegionBox(1);
  box.region_names = {"3", "7"};
  const auto path = FreshFolder() / "box.vtu";

  WriteVtu(path, box);

  EXPECT_EQ(ReadMesh(path, 1).region_names, box.region_names);
}

TEST(WriteVtu, LeavesOutTheRegionOfAMeshThatHasOneWithoutAName) {
  const auto path = FreshFolder() / "box.vtu";

  WriteVtu(path, softforce::testing::MakeBox(1, 1, 1, {1, 1, 1}));

  EXPECT_EQ(ReadMesh(path, 1).region_names, std::vector<std::string>{""});
}

TEST(WriteVtu, GivesTheSameBytesForTheSameMesh) {
  const auto folder = FreshFolder();

  WriteVtu(folder / "one.vtu", MakeTwoRegionBox(2));
  WriteVtu(folder / "other.vtu", MakeTwoRegionBox(2));

  EXPECT_EQ(ReadText(folder / "one.vtu"), ReadText(folder / "other.vtu"));
}

TEST(WriteSurfaceVtu, HasTheTrianglesAndTheirValuesOnly) {
  const TetMesh box = MakeTwoRegionBox(2);
  const Surface surface = ExtractSurface(box);
  const auto path = FreshFolder() / "surface.vtu";

  WriteSurfaceVtu(path, surface, box.nodes,
                  {{"error_mm", Eigen::VectorXd::Ones(surface.num_triangles())}});

  const std::string text = ReadText(path);
  EXPECT_THAT(text, ::testing::HasSubstr("Name=\"error_mm\""));
  EXPECT_THAT(text, ::testing::HasSubstr("NumberOfCells=\"" +
                                         std::to_string(surface.num_triangles()) + "\""));
  // A closed surface of 6-node triangles: Euler's formula gives 2 T + 2 nodes.
  EXPECT_THAT(text, ::testing::HasSubstr("NumberOfPoints=\"" +
                                         std::to_string(2 * surface.num_triangles() + 2) + "\""));
}

TEST(WriteVtu, RefusesAFolderThatDoesNotExist) {
  const auto path = FreshFolder() / "none" / "box.vtu";
  EXPECT_THAT(
      [&] { WriteVtu(path, MakeTwoRegionBox(1)); },
      ::testing::ThrowsMessage<base::InputError>(::testing::HasSubstr("cannot be written")));
}

}  // namespace
}  // namespace softforce::mesh
