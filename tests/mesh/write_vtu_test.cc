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

TEST(WriteVtu, RefusesAFolderThatDoesNotExist) {
  const auto path = FreshFolder() / "none" / "box.vtu";
  EXPECT_THAT(
      [&] { WriteVtu(path, MakeTwoRegionBox(1)); },
      ::testing::ThrowsMessage<base::InputError>(::testing::HasSubstr("cannot be written")));
}

}  // namespace
}  // namespace softforce::mesh
