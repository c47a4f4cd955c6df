#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acceptance/program.h"
#include "mesh/stl_shapes.h"
#include "softforce/mesh/read_mesh.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;
using testing::CubeSurface;
using testing::StlText;

constexpr char kRoundBody[] =
    "SetFactory(\"OpenCASCADE\");\nCylinder(1) = {0, 0, 0, 0, 0, 30, 12};\n"
    "Sphere(2) = {0, 0, 15, 6};\n"
    "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n";

testing::ProgramResult Mesh(const std::string& arguments) {
  return testing::RunProgram("mesh " + arguments);
}

// A STEP file of a cylinder with a round hollow, made by the program `gmsh` as a CAD program would.
bool WriteStep(const Folder& folder) {
  testing::WriteText(folder / "body.geo", kRoundBody);
  return testing::RunCommand(
             fmt::format("gmsh -0 '{0}/body.geo' -o '{0}/body.step'", folder.string()))
                 .exit_code == 0 &&
         std::filesystem::exists(folder / "body.step");
}

TEST(MeshCommand, MakesAPressureChamberFromAStepFile) {
  const Folder folder = testing::FreshFolder("mesh_step");
  if (!WriteStep(folder)) GTEST_SKIP() << "the program gmsh is not installed";

  const testing::ProgramResult run = Mesh(fmt::format(
      "'{0}/body.step' '{0}/body.msh' --size '4 mm' --group chamber=cavity --group base=z-min "
      "--group 'side=near(12 0 15 mm, 30 deg)' --order 2",
      folder.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.errors, "");
  for (const char* words :
       {"cells of 10 nodes", "closed cavities       1", "chamber", "around 0.7"}) {
    EXPECT_NE(run.output.find(words), std::string::npos) << words << " is not in " << run.output;
  }
  const mesh::TetMesh read = mesh::ReadMesh(folder / "body.msh", 1e-3);
  EXPECT_EQ(read.order(), 2);
  EXPECT_EQ(read.surface_groups.count("base"), 1u);
  EXPECT_EQ(read.surface_groups.count("chamber"), 1u);
  EXPECT_EQ(read.surface_groups.count("side"), 1u);
}

TEST(MeshCommand, WritesWhatGmshReadsWithoutAComplaint) {
  const Folder folder = testing::FreshFolder("mesh_gmsh");
  const std::string sheet = (Folder(SOFTFORCE_SOURCE_DIR) / "meshes/sheet.msh").string();
  if (testing::RunCommand("gmsh --version").exit_code != 0) {
    GTEST_SKIP() << "the program gmsh is not installed";
  }
  ASSERT_EQ(Mesh(fmt::format("'{}' '{}/sheet.msh'", sheet, folder.string())).exit_code, 0);

  const testing::ProgramResult gmsh =
      testing::RunCommand(fmt::format("gmsh -v 4 -check '{}/sheet.msh' -", folder.string()));

  EXPECT_EQ(gmsh.exit_code, 0);
  EXPECT_NE(gmsh.output.find("1699 nodes"), std::string::npos) << gmsh.output;
  EXPECT_EQ((gmsh.output + gmsh.errors).find("Error"), std::string::npos);
  EXPECT_EQ((gmsh.output + gmsh.errors).find("Warning"), std::string::npos);
}

TEST(MeshCommand, MakesAMeshFromAnStlFile) {
  const Folder folder = testing::FreshFolder("mesh_stl");
  testing::WriteText(folder / "cube.stl", StlText(CubeSurface({0, 0, 0}, 2)));

  const testing::ProgramResult run = Mesh(fmt::format(
      "'{0}/cube.stl' '{0}/cube.vtu' --unit cm --out-unit m --size '5 mm'", folder.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("20.00 x 20.00 x 20.00 mm"), std::string::npos) << run.output;
  EXPECT_NEAR(mesh::ReadMesh(folder / "cube.vtu", 1).nodes.maxCoeff(), 0.02, 1e-9);  // m
}

TEST(MeshCommand, OnlyChecksWithoutAnOutput) {
  const Folder folder = testing::FreshFolder("mesh_check");
  std::filesystem::copy(Folder(SOFTFORCE_SOURCE_DIR) / "meshes/robot.msh", folder);

  const testing::ProgramResult run = Mesh(fmt::format("'{}/robot.msh'", folder.string()));

  EXPECT_EQ(run.exit_code, 0) << run.errors;
  for (const char* words : {"4165 cells of 4 nodes", "feet", "platform_top", "Quality"}) {
    EXPECT_NE(run.output.find(words), std::string::npos) << words << " is not in " << run.output;
  }
  EXPECT_EQ(run.output.find("Written"), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

const Folder kDataset = Folder(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights";

// A coarse mesh of the dataset's sheet and its scene in a new folder, without the recording.
Folder SceneWithoutRecording(const std::string& name) {
  const Folder folder = testing::FreshFolder(name);
  std::filesystem::copy(kDataset / "scene.yaml", folder);
  testing::WriteText(folder / "sheet.geo",
                     "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 200, 200, 10};\n");
  return folder;
}

TEST(MeshCommand, JudgesAMeshInASceneBeforeAnythingIsRecorded) {
  const Folder folder = SceneWithoutRecording("mesh_scene");

  const testing::ProgramResult run = Mesh(fmt::format(
      "'{0}/sheet.geo' '{0}/sheet.msh' --size '25 mm' --scene '{0}/scene.yaml' --load '0.3 N' "
      "--bias-field '{0}/bias.vtu'",
      folder.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const char* words :
       {"Forces found with this mesh are", "Displacements change by +", "0.3 N on every candidate",
        "What to do: refine", "Where to refine", "candidate 1", "marker 13"}) {
    EXPECT_NE(run.output.find(words), std::string::npos) << words << " is not in " << run.output;
  }
  EXPECT_EQ(run.output.find("nan"), std::string::npos) << run.output;
  EXPECT_TRUE(std::filesystem::exists(folder / "sheet.msh"));
  EXPECT_NE(testing::ReadText(folder / "bias.vtu").find("bias_share"), std::string::npos);
}

// Arguments that are refused after IN, and what is named.
struct RefusedScene {
  const char* name;
  const char* arguments;
  const char* named;
};

void PrintTo(const RefusedScene& refused, std::ostream* out) { *out << refused.name; }

class RefusedInAScene : public ::testing::TestWithParam<RefusedScene> {};

TEST_P(RefusedInAScene, LeavesEveryFileAsItWas) {
  const Folder folder = SceneWithoutRecording(std::string("mesh_scene_bad_") + GetParam().name);
  const std::string scene = testing::ReadText(folder / "scene.yaml");
  const std::string corner = "{box: {min: 0 0 0 mm, max: 10 10 10 mm}}";
  const std::size_t at = scene.find(corner);
  ASSERT_NE(at, std::string::npos);
  const auto with = [&](const char* fixed) {
    return std::string(scene).replace(at, corner.size(), fixed);
  };
  testing::WriteText(folder / "held.yaml", with("{box: {min: 0 0 0 mm, max: 200 200 10 mm}}"));
  testing::WriteText(folder / "group.yaml", with("{group: nowhere}"));

  const testing::ProgramResult run = Mesh(fmt::format(
      fmt::runtime(GetParam().arguments),
      (folder / "sheet.geo").string() + "' '" + (folder / "out.msh").string() + "' --size '25 mm",
      folder.string()));

  EXPECT_EQ(run.exit_code, 2) << run.output << run.errors;
  EXPECT_NE(run.errors.find(GetParam().named), std::string::npos) << run.errors;
  EXPECT_EQ(testing::ReadText(folder / "scene.yaml"), scene);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.msh"));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedInAScene,
    ::testing::Values(
        RefusedScene{"LoadBelowZero", "'{0}' --scene '{1}/scene.yaml' --load '-0.5 N'", "--load"},
        RefusedScene{"LoadOfAnotherKind", "'{0}' --scene '{1}/scene.yaml' --load '1 mm'", "--load"},
        RefusedScene{"LoadWithoutScene", "'{0}' --load '1 N'", "need --scene"},
        RefusedScene{"BiasFieldOfAnotherKind",
                     "'{0}' --scene '{1}/scene.yaml' --bias-field '{1}/scene.yaml'",
                     "must end in .vtu"},
        RefusedScene{"BiasFieldWithoutFolder",
                     "'{0}' --scene '{1}/scene.yaml' --bias-field '{1}/none/bias.vtu'",
                     "cannot be written"},
        RefusedScene{"EverythingHeld", "'{0}' --scene '{1}/held.yaml'", "nothing can move"},
        RefusedScene{"MissingGroup", "'{0}' --scene '{1}/group.yaml'", "nowhere"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(MeshCommand, DoesNotWriteABiasFieldOverItsInput) {
  const Folder folder = SceneWithoutRecording("mesh_scene_onto_input");
  testing::WriteText(folder / "in.vtu", "precious");

  const testing::ProgramResult run = Mesh(fmt::format(
      "'{0}/in.vtu' --scene '{0}/scene.yaml' --bias-field '{0}/./in.vtu'", folder.string()));

  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.errors.find("--bias-field"), std::string::npos) << run.errors;
  EXPECT_EQ(testing::ReadText(folder / "in.vtu"), "precious");
}

TEST(MeshCommand, ExplainsItsSelectors) {
  const testing::ProgramResult run = Mesh("--help");

  EXPECT_EQ(run.exit_code, 0);
  for (const char* words : {"--size", "--group", "cavity", "near("}) {
    EXPECT_NE(run.output.find(words), std::string::npos) << words;
  }
}

// A command that is refused: its arguments after the folder's body.stl, and what is named.
struct Refused {
  const char* name;
  std::string stl;
  const char* arguments;  // {0} is the folder
  const char* named;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

const auto kCube = CubeSurface({0, 0, 0}, 20);

const Refused kRefused[] = {
    {"Missing", "", "'{0}/none.stl' '{0}/out.msh'", "no such file"},
    {"NotClosed", StlText({kCube.begin() + 1, kCube.end()}), "'{0}/body.stl' '{0}/out.msh'",
     "not closed"},
    {"UnknownOutput", StlText(kCube), "'{0}/body.stl' '{0}/out.obj'", "must be .msh"},
    {"NoFolder", StlText(kCube), "'{0}/body.stl' '{0}/none/out.msh'", "cannot be written"},
    {"SizeWithoutUnit", StlText(kCube), "'{0}/body.stl' '{0}/out.msh' --size 5", "--size"},
    {"UnknownUnit", StlText(kCube), "'{0}/body.stl' '{0}/out.msh' --unit inch", "--unit"},
    {"OrderThree", StlText(kCube), "'{0}/body.stl' '{0}/out.msh' --order 3", "--order"},
    {"EmptyGroup", StlText(kCube), "'{0}/body.stl' '{0}/out.msh' --group a=cavity",
     "selects no triangle"},
};

class RefusedMesh : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedMesh, EndsWithOneMessageAndLeavesNothing) {
  const Refused& refused = GetParam();
  const Folder folder = testing::FreshFolder(std::string("mesh_bad_") + refused.name);
  testing::WriteText(folder / "body.stl", refused.stl);

  const testing::ProgramResult run =
      Mesh(fmt::format(fmt::runtime(refused.arguments), folder.string()));

  EXPECT_EQ(run.exit_code, 2) << run.output << run.errors;
  EXPECT_EQ(run.errors.rfind("softforce: ", 0), 0u) << run.errors;
  EXPECT_EQ(run.errors.find("softforce: ", 1), std::string::npos) << run.errors;
  EXPECT_NE(run.errors.find(refused.named), std::string::npos) << run.errors;
  EXPECT_EQ(run.output, "");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);  // body.stl
}

INSTANTIATE_TEST_SUITE_P(All, RefusedMesh, ::testing::ValuesIn(kRefused),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(MeshCommand, LeavesTheOldFileWhenItIsRefused) {
  const Folder folder = testing::FreshFolder("mesh_old");
  testing::WriteText(folder / "body.stl", StlText(kCube));
  testing::WriteText(folder / "out.msh", "old");

  const testing::ProgramResult run =
      Mesh(fmt::format("'{0}/body.stl' '{0}/out.msh' --group a=cavity", folder.string()));

  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(testing::ReadText(folder / "out.msh"), "old");
}

}  // namespace
}  // namespace softforce
