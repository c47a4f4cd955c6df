#include "softforce/mesh/prepare_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/mesh_files.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"
#include "softforce/mesh/write_mesh.h"

namespace softforce::mesh {
namespace {

using softforce::testing::FreshFolder;
using softforce::testing::MakeTwoRegionBox;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// The two-region box in a file in millimetres.
std::filesystem::path BoxFile(int order) {
  const auto path = FreshFolder() / "box.msh";
  WriteMesh(path, MakeTwoRegionBox(order), 1e-3);
  return path;
}

TEST(PrepareMesh, RaisesAndLowersTheOrder) {
  for (const int from : {1, 2}) {
    for (const int to : {1, 2}) {
      const auto in = BoxFile(from), out = in.parent_path() / "out.msh";
      PrepareOptions options;
      options.order = to;

      const PreparedMesh prepared = PrepareMesh(in, out, options);
      EXPECT_EQ(prepared.report.order, to);
      WriteMesh(out, prepared.mesh, prepared.out_metres_per_unit);
      const TetMesh read = ReadMesh(out, 1e-3);

      EXPECT_EQ(read.order(), to);
      EXPECT_EQ(read.region_names, (std::vector<std::string>{"soft", "stiff"}));
      EXPECT_EQ(read.surface_groups.size(), 2u);
    }
  }
}

TEST(PrepareMesh, KeepsTheOrderUnlessAsked) {
  EXPECT_EQ(PrepareMesh(BoxFile(1), "").report.order, 1);
  EXPECT_EQ(PrepareMesh(BoxFile(2), "").report.order, 2);
}

TEST(PrepareMesh, ConvertsAFileOntoItself) {
  const auto path = BoxFile(2);
  const std::string before = softforce::testing::ReadText(path);

  const PreparedMesh prepared = PrepareMesh(path, path);
  WriteMesh(path, prepared.mesh, prepared.out_metres_per_unit);

  EXPECT_EQ(softforce::testing::ReadText(path), before);
}

TEST(PrepareMesh, WarnsThatVtkFilesLoseGroups) {
  const auto in = BoxFile(1);

  EXPECT_THAT(PrepareMesh(in, in.parent_path() / "out.vtu").report.warnings,
              Contains(HasSubstr("keeps no surface groups")));
}

TEST(PrepareMesh, WarnsThatVtkFilesLoseNamesOfRegions) {
  const auto in = BoxFile(1);

  EXPECT_THAT(PrepareMesh(in, in.parent_path() / "out.vtk").report.warnings,
              Contains(HasSubstr("not the names \"soft\", \"stiff\"")));
}

TEST(PrepareMesh, WritesNothingAndRefusesWhatCannotBeWritten) {
  const auto in = BoxFile(1);

  PrepareMesh(in, in.parent_path() / "out.msh");

  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(in.parent_path()), {}), 1);
  EXPECT_THAT([&] { PrepareMesh(in, in.parent_path() / "none/out.msh"); },
              ThrowsMessage<base::InputError>(HasSubstr("cannot be written")));
}

TEST(PrepareMesh, WarnsOfVolumesThatAreLeftOut) {
  const auto geo = softforce::testing::WriteText(
      FreshFolder() / "body.geo",
      "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 10, 10, 10};\n"
      "Box(2) = {20, 0, 0, 30, 10, 10};\nPhysical Volume(\"body\") = {1};\n");
  PrepareOptions options;
  options.generate.size = 5e-3;  // m

  const PreparedMesh prepared = PrepareMesh(geo, "", options);

  EXPECT_EQ(prepared.mesh.region_names, std::vector<std::string>{"body"});
  EXPECT_THAT(prepared.report.warnings, Contains(HasSubstr("volume 2, 75.0 % of the whole")));
}

TEST(PrepareMesh, TakesExtensionsInCapitals) {
  const auto in = BoxFile(1), capitals = in.parent_path() / "BOX.MSH";
  std::filesystem::rename(in, capitals);

  const PreparedMesh prepared = PrepareMesh(capitals, in.parent_path() / "OUT.VTU");
  WriteMesh(in.parent_path() / "OUT.VTU", prepared.mesh, prepared.out_metres_per_unit);

  EXPECT_EQ(ReadMesh(in.parent_path() / "OUT.VTU", 1e-3).num_elements(), prepared.report.elements);
}

TEST(PrepareMesh, RefusesAMeshThatCheckMeshRefusesAndWritesNothing) {
  TetMesh box = MakeTwoRegionBox(1);
  std::swap(box.elements(0, 3), box.elements(1, 3));
  const auto folder = FreshFolder();
  WriteMesh(folder / "box.msh", box, 1e-3);

  EXPECT_THAT([&] { PrepareMesh(folder / "box.msh", folder / "out.msh"); },
              ThrowsMessage<base::InputError>(HasSubstr("inverted")));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.msh"));
}

TEST(PrepareMesh, RefusesASizeForAFinishedMesh) {
  PrepareOptions options;
  options.generate.size = 1e-3;

  EXPECT_THAT([&] { PrepareMesh(BoxFile(1), "", options); },
              ThrowsMessage<base::InputError>(HasSubstr("--size")));
}

TEST(PrepareOptions, RefuseAnOrderOutOfRange) {
  for (const int order : {-1, 3}) {
    PrepareOptions options;
    options.order = order;
    EXPECT_THAT([&] { options.Check(); }, ThrowsMessage<base::InputError>(HasSubstr("--order")));
  }
}

}  // namespace
}  // namespace softforce::mesh
