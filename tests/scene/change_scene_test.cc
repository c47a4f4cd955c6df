#include "softforce/scene/change_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene/temp_scene.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string TextOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

const std::string kPlain = testing::kSceneText;

TEST(WriteChangedScene, ReplacesTheNumbersAndNothingElse) {
  const fs::path file = testing::WriteScene("# the finger, third pour\n" + kPlain);
  const fs::path out = testing::TempFolder() / "identified.yaml";

  WriteChangedScene(
      file, {{{"soft", 281234.56}}, {{"hard", 0.3125}}, {{"left", 0.125e-3}, {"right", -0.05}}},
      out);

  std::string expected = "# the finger, third pour\n" + kPlain;
  expected = testing::Replaced(expected, "290 kPa", "281.235 kPa");
  expected = testing::Replaced(expected, "poissons_ratio: 0.3}", "poissons_ratio: 0.3125}");
  expected =
      testing::Replaced(expected, "input: displacement", "input: displacement, offset: 0.125 mm");
  expected = testing::Replaced(expected, "input: tension", "input: tension, offset: -0.05 N");
  EXPECT_EQ(TextOf(out), expected);
}

TEST(WriteChangedScene, InPlaceReplacesAnOldOffset) {
  const fs::path file = testing::WriteScene(
      testing::Replaced(kPlain, "input: displacement", "offset: \"200 um\", input: displacement"));

  WriteChangedScene(file, {{}, {}, {{"left", 0.25e-3}}}, file);

  EXPECT_THAT(TextOf(file), HasSubstr("offset: \"250 um\", input: displacement, patch"));
  EXPECT_NEAR(LoadScene(file, SceneFiles::kNone).actuators[0].offset, 0.25e-3, 1e-9);  // m
}

TEST(WriteChangedScene, KeepsBlocksCommentsAndLineEndings) {
  std::string text = testing::Replaced(
      kPlain,
      "  - {name: left, type: cable, points: [20 0 45 mm, 10 0 20 mm], guide: 0 0 5 mm, input: "
      "displacement, patch: 6 mm}\n",
      "  - name: left\n    type: cable\n    points: [20 0 45 mm]\n    guide: 0 0 5 mm  # brass\n"
      "    input: displacement  # of the motor\n    patch: 6 mm\n");
  std::string dos = "\xEF\xBB\xBF";
  for (const char c : text) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const fs::path file = testing::WriteScene(dos);

  WriteChangedScene(file, {{{"hard", 2.5e6}}, {}, {{"left", 1e-3}}}, file);

  const std::string expected = testing::Replaced(
      testing::Replaced(dos, "of the motor\r\n", "of the motor\r\n    offset: 1 mm\r\n"), "2 MPa",
      "2.5 MPa");
  EXPECT_EQ(TextOf(file), expected);
}

TEST(WriteChangedScene, KeepsPathsRightInAnotherFolder) {
  const fs::path file = testing::WriteScene(kPlain);
  const fs::path folder = testing::TempFolder() / "runs: #1";
  fs::create_directories(folder);
  const Scene before = LoadScene(file);

  WriteChangedScene(file, {{{"soft", 300e3}}, {}, {}}, folder / "scene.yaml");

  const Scene after = LoadScene(folder / "scene.yaml");
  EXPECT_EQ(after.mesh.file, before.mesh.file);
  EXPECT_EQ(after.cameras.rig, before.cameras.rig);
  EXPECT_EQ(after.cameras.sources, before.cameras.sources);
  EXPECT_EQ(after.actuation_file, before.actuation_file);
  EXPECT_THAT(TextOf(folder / "scene.yaml"), HasSubstr("file: ../finger.msh, unit"));

  // And back, from a folder whose name needs quotes.
  fs::rename(testing::TempFolder() / "finger.msh", folder / "finger.msh");
  testing::WriteFile(folder / "scene.yaml", testing::Replaced(TextOf(folder / "scene.yaml"),
                                                              "../finger.msh", "finger.msh"));
  WriteChangedScene(folder / "scene.yaml", {}, file);
  EXPECT_EQ(LoadScene(file).mesh.file, folder / "finger.msh");
  EXPECT_THAT(TextOf(file), HasSubstr("file: \"runs: #1/finger.msh\""));
}

TEST(WriteChangedScene, KeepsThePathsOfASimulationRight) {
  const fs::path file = testing::WriteScene(
      kPlain +
      "simulation:\n  mesh: {file: fine.msh, unit: mm}\n  forces: loads.csv\n  actuation: "
      "told.csv\n");
  const fs::path folder = testing::TempFolder() / "elsewhere";
  fs::create_directories(folder);

  WriteChangedScene(file, {}, folder / "scene.yaml");

  const Scene after = LoadScene(folder / "scene.yaml", SceneFiles::kNone);
  EXPECT_EQ(after.simulation->mesh_file, testing::TempFolder() / "fine.msh");
  EXPECT_EQ(after.simulation->forces_file, testing::TempFolder() / "loads.csv");
  EXPECT_EQ(after.simulation->actuation_file, testing::TempFolder() / "told.csv");
}

TEST(WriteChangedScene, KeepsALinkAndThePermissionsOfTheFileBehindIt) {
  const fs::path file = testing::WriteScene(kPlain);
  const fs::perms owner_only = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(file, owner_only);
  const fs::path link = testing::TempFolder() / "links" / "current.yaml";
  fs::create_directories(link.parent_path());
  fs::remove(link);
  fs::create_symlink(file, link);

  WriteChangedScene(file, {{{"soft", 300e3}}, {}, {}}, link);

  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(TextOf(file), testing::Replaced(kPlain, "290 kPa", "300 kPa"));
  EXPECT_EQ(fs::status(file).permissions(), owner_only);
}

TEST(WriteChangedScene, RefusesWhatIsNotWrittenOut) {
  const std::string with_alias =
      testing::Replaced(testing::Replaced(kPlain, "290 kPa", "&E 290 kPa"), "2 MPa", "*E");
  const fs::path file = testing::WriteScene(with_alias);
  try {
    WriteChangedScene(file, {{{"soft", 300e3}}, {}, {}}, file);
    ADD_FAILURE() << "it was accepted";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("enter by hand: 300 kPa"));
  }
  EXPECT_EQ(TextOf(file), with_alias);
}

TEST(WriteChangedScene, RefusesAFolderThatIsNotThere) {
  const fs::path file = testing::WriteScene(kPlain);
  EXPECT_THROW(WriteChangedScene(file, {}, testing::TempFolder() / "nowhere" / "scene.yaml"),
               base::InputError);
}

TEST(Scene, ReadsTheOffsetOfACable) {
  const fs::path file = testing::WriteScene(testing::Replaced(
      testing::Replaced(kPlain, "input: displacement", "input: displacement, offset: -0.2 mm"),
      "input: tension", "input: tension, offset: 30 mN"));
  const Scene scene = LoadScene(file);
  EXPECT_DOUBLE_EQ(scene.actuators[0].offset, -0.2e-3);  // m
  EXPECT_DOUBLE_EQ(scene.actuators[1].offset, 0.03);     // N
}

TEST(Scene, RefusesAnOffsetOfTheWrongKind) {
  EXPECT_THAT(testing::SceneRefusal("input: tension", "input: tension, offset: 3 mm"),
              HasSubstr("actuators[1]: offset: \"3 mm\""));
  EXPECT_THAT(testing::SceneRefusal("group: cavity", "group: cavity, offset: 3 mm"),
              HasSubstr("offset"));
}

}  // namespace
}  // namespace softforce::scene
