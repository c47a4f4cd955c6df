#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

using ::testing::HasSubstr;
using testing::kSceneText;
using testing::SceneRefusal;
using ::testing::StartsWith;

TEST(SceneRefusal, NamesAMissingSceneFile) {
  try {
    LoadScene("no/such/scene.yaml");
    FAIL() << "it was accepted";
  } catch (const base::InputError& error) {
    EXPECT_STREQ(error.what(), "no/such/scene.yaml: there is no such file");
  }
}

TEST(SceneRefusal, GivesTheLineOfASyntaxError) {
  EXPECT_THAT(SceneRefusal("order: 1}", "order: 1"), StartsWith("scene.yaml:5: is not valid YAML"));
}

TEST(SceneRefusal, NamesAnEmptyFile) {
  EXPECT_EQ(SceneRefusal(kSceneText, ""), "scene.yaml:1: got nothing, expected keys with values");
}

TEST(SceneRefusal, NamesAnUnknownFormatVersion) {
  EXPECT_THAT(SceneRefusal("softforce: 1", "softforce: 2"),
              StartsWith("scene.yaml:1: softforce: got format version 2, expected 1"));
}

TEST(SceneRefusal, ListsTheKnownKeysForAnUnknownOne) {
  EXPECT_EQ(SceneRefusal("order: 1", "odrer: 1"),
            "scene.yaml:4: body: mesh: odrer: unknown key, expected one of file, order, unit\n"
            "  Did you mean \"order\"?");
}

TEST(SceneRefusal, SeesAMissingKeyInAMisspeltOne) {
  EXPECT_EQ(SceneRefusal("  material:", "  meterial:"),
            "scene.yaml:5: body: meterial: unknown key, expected \"material\", which is missing\n"
            "  Did you mean \"material\"?");
}

TEST(SceneRefusal, NamesUnknownKeysInEverySection) {
  const std::pair<const char*, const char*> insertions[] = {
      {"name: finger", "name: finger\nzzz: 1"},
      {"  gravity", "  zzz: 1\n  gravity"},
      {"model: corotational", "zzz: 1, model: corotational"},
      {"{group: base}", "{group: base, zzz: 1}"},
      {"min: 0 0 0 mm", "min: 0 0 0 mm, zzz: 1"},
      {"name: left", "zzz: 1, name: left"},
      {"group: cavity", "group: cavity, zzz: 1"},
      {"  size: 14 mm", "  size: 14 mm\n  zzz: 1"},
      {"{id: 7", "{zzz: 1, id: 7"},
      {"  known: false", "  known: false\n  zzz: 1"},
      {"{id: 1,", "{zzz: 1, id: 1,"},
      {"  rig: rig.yaml", "  rig: rig.yaml\n  zzz: 1"},
      {"corners:", "zzz: 1, corners:"},
  };
  for (const auto& [from, to] : insertions) {
    EXPECT_THAT(SceneRefusal(from, to), HasSubstr("zzz: unknown key, expected one of ")) << to;
  }
}

TEST(SceneRefusal, NamesAMissingKeyAndWhatItIsFor) {
  EXPECT_EQ(SceneRefusal(", unit: mm", ""),
            "scene.yaml:4: body: mesh: missing key \"unit\", got only file, order\n"
            "  Mesh files do not say their unit: mm, m, …");
}

TEST(SceneRefusal, NamesAKeyGivenTwice) {
  EXPECT_EQ(SceneRefusal("  size: 14 mm", "  size: 14 mm\n  size: 15 mm"),
            "scene.yaml:22: markers: size: the key is given twice, expected once");
}

TEST(SceneRefusal, NamesAQuantityWithoutUnit) {
  EXPECT_EQ(
      SceneRefusal("size: 14 mm", "size: 14"),
      "scene.yaml:21: markers: size: \"14\": got no unit, expected a length in m, cm, mm, um, "
      "\u00b5m, \u03bcm\n  Write for example: 6 mm");
}

TEST(SceneRefusal, NamesAQuantityThatIsNotPositive) {
  EXPECT_EQ(SceneRefusal("size: 14 mm", "size: 0 mm"),
            "scene.yaml:21: markers: size: got \"0 mm\", expected more than 0");
}

TEST(SceneRefusal, NamesValuesOfAWrongType) {
  EXPECT_EQ(SceneRefusal("30 50 10 mm", "[30, 50, 10]"),
            "scene.yaml:24: markers: points[1]: position: got a list, expected three numbers and "
            "their unit in one text, without [ ]");
  EXPECT_EQ(
      SceneRefusal("{id: 7", "{id: seven"),
      "scene.yaml:24: markers: points[1]: id: got \"seven\", expected a whole number, at least 0");
  EXPECT_EQ(
      SceneRefusal("{id: 7", "{id: -7"),
      "scene.yaml:24: markers: points[1]: id: got \"-7\", expected a whole number, at least 0");
  EXPECT_EQ(SceneRefusal("known: false", "known: maybe"),
            "scene.yaml:26: forces: known: got \"maybe\", expected true, false");
  EXPECT_EQ(SceneRefusal("name: finger", "name:"),
            "scene.yaml:2: name: got nothing, expected a text");
}

TEST(SceneRefusal, NamesAMeshThatIsNotThere) {
  EXPECT_THAT(SceneRefusal("finger.msh", "fingre.msh"),
              StartsWith("scene.yaml:4: body: mesh: file: there is no file fingre.msh"));
}

TEST(SceneRefusal, NamesAMeshUnitThatIsNoLength) {
  EXPECT_THAT(SceneRefusal("unit: mm", "unit: kPa"),
              StartsWith("scene.yaml:4: body: mesh: unit: got the unit \"kPa\" of a pressure, "
                         "expected a length"));
}

TEST(SceneRefusal, NamesAnOrderThatIsNotThere) {
  EXPECT_EQ(SceneRefusal("order: 1", "order: 3"),
            "scene.yaml:4: body: mesh: order: got \"3\", expected 1, 2");
}

TEST(SceneRefusal, ListsTheMaterialModels) {
  EXPECT_EQ(SceneRefusal("neo_hookean", "neohookean"),
            "scene.yaml:6: body: material: soft: model: got \"neohookean\", expected corotational, "
            "st_venant_kirchhoff, neo_hookean, neo_hookean_logarithmic\n"
            "  Did you mean \"neo_hookean\"?");
}

TEST(SceneRefusal, NamesAMaterialOutOfRange) {
  EXPECT_THAT(SceneRefusal("youngs_modulus: 290 kPa", "youngs_modulus: 29 Pa"),
              HasSubstr("got 29 Pa, expected 100 to 1.3e+12 Pa"));
  EXPECT_THAT(SceneRefusal("youngs_modulus: 290 kPa", "youngs_modulus: 290000 GPa"),
              HasSubstr("got 2.9e+14 Pa"));
  EXPECT_THAT(SceneRefusal("youngs_modulus: 290 kPa", "youngs_modulus: -290 kPa"),
              HasSubstr("must be greater than 0"));
  EXPECT_THAT(SceneRefusal("poissons_ratio: 0.45", "poissons_ratio: 0.5"),
              StartsWith("scene.yaml:6: body: material: soft: "));
}

TEST(SceneRefusal, WantsSomethingFixed) {
  const std::string fixed =
      "  fixed:\n    - {box: {min: 0 0 0 mm, max: 10 20 30 mm}}\n    - {group: base}\n";
  EXPECT_EQ(SceneRefusal(fixed, ""),
            "scene.yaml:3: body: missing key \"fixed\", got only mesh, material, gravity, density\n"
            "  With nothing fixed the body would float away.");
  EXPECT_EQ(SceneRefusal(fixed, "  fixed: []\n"),
            "scene.yaml:8: body: fixed: got an empty list, expected at least one item\n"
            "  With nothing fixed the body would float away.");
}

TEST(SceneRefusal, WantsEitherABoxOrAGroup) {
  EXPECT_THAT(SceneRefusal("{group: base}", "{}"),
              StartsWith("scene.yaml:10: body: fixed[1]: got neither, expected a box or a group"));
  EXPECT_THAT(SceneRefusal("{group: base}", "{group: a, box: {min: 0 0 0 m, max: 1 1 1 m}}"),
              StartsWith("scene.yaml:10: body: fixed[1]: got both a box and a group"));
}

TEST(SceneRefusal, NamesABoxInsideOut) {
  EXPECT_THAT(SceneRefusal("10 20 30 mm", "10 -20 30 mm"),
              StartsWith("scene.yaml:9: body: fixed[0]: box: got a min greater than the max"));
}

TEST(SceneRefusal, WantsADensityForGravity) {
  EXPECT_EQ(SceneRefusal("  density: 1.07 g/cm^3\n", ""),
            "scene.yaml:3: body: missing key \"density\", got only mesh, material, fixed, gravity\n"
            "  Gravity pulls in proportion to it.");
  EXPECT_EQ(SceneRefusal("1.07 g/cm^3", "0 g/cm^3"),
            "scene.yaml:12: body: density: got \"0 g/cm^3\", expected more than 0");
}

TEST(SceneRefusal, WantsAFamilyForTagsOnly) {
  EXPECT_THAT(SceneRefusal("  family: tag25h9\n", ""), HasSubstr("missing key \"family\""));
  EXPECT_THAT(SceneRefusal("type: apriltag", "type: dot"),
              HasSubstr("markers: family: unknown key, expected one of points, size, type"));
}

TEST(SceneRefusal, NamesIdsGivenTwice) {
  EXPECT_EQ(SceneRefusal("{id: 7", "{id: 0"),
            "scene.yaml:24: markers: points[1]: id 0 is given twice, expected once");
  EXPECT_EQ(SceneRefusal("{id: 2", "{id: 1"),
            "scene.yaml:31: forces: candidates[2]: id 1 is given twice, expected once");
  EXPECT_EQ(SceneRefusal("name: right", "name: left"),
            "scene.yaml:15: actuators[1]: name \"left\" is given twice, expected once");
}

TEST(SceneRefusal, NamesEmptyLists) {
  EXPECT_THAT(
      SceneRefusal("    - {id: 0, position: 30 40 10 mm}\n    - {id: 7, position: 30 50 10 mm}",
                   "    []"),
      HasSubstr("markers: points: got an empty list, expected at least one item"));
  EXPECT_THAT(SceneRefusal("points: [-20 0 45 mm]", "points: []"),
              HasSubstr("actuators[1]: points: got an empty list, expected at least one item"));
}

TEST(SceneRefusal, WantsCandidates) {
  const std::string text = kSceneText;
  const size_t begin = text.find("    - {id: 0, position: 65");
  const std::string candidates = text.substr(begin, text.find("cameras:") - begin);
  EXPECT_THAT(SceneRefusal(candidates, "    []\n"),
              HasSubstr("forces: candidates: got an empty list, expected at least one item"));
}

TEST(SceneRefusal, NamesADirectionThatIsNone) {
  EXPECT_EQ(SceneRefusal("direction: free", "direction: fre"),
            "scene.yaml:29: forces: candidates[0]: direction: got \"fre\", expected free, normal\n"
            "  Did you mean \"free\"?");
  EXPECT_THAT(SceneRefusal("[0, 3, -4]", "[0, 0, 0]"),
              HasSubstr("got [0, 0, 0], expected a direction"));
  EXPECT_THAT(SceneRefusal("[0, 3, -4]", "[0, 3]"), HasSubstr("got 2 items, expected 3"));
}

TEST(SceneRefusal, KeepsInputsToTheirActuators) {
  EXPECT_EQ(SceneRefusal("input: tension", "input: pressure"),
            "scene.yaml:15: actuators[1]: input: got \"pressure\", expected displacement, tension");
  EXPECT_EQ(SceneRefusal("group: cavity", "group: cavity, input: tension"),
            "scene.yaml:16: actuators[2]: input: got \"tension\", expected pressure");
}

TEST(SceneRefusal, WantsAnUncertaintyInTheActuatorsUnit) {
  EXPECT_THAT(SceneRefusal("input: tension", "input: tension, uncertainty: 1 mm"),
              HasSubstr("actuators[1]: uncertainty: \"1 mm\": got the unit \"mm\" of a length, "
                        "expected a force"));
  EXPECT_THAT(SceneRefusal("input: tension", "input: tension, uncertainty: 0 N"),
              HasSubstr("actuators[1]: uncertainty"));
}

TEST(SceneRefusal, WantsPointsAndGuideOfACable) {
  EXPECT_THAT(SceneRefusal("points: [-20 0 45 mm], ", ""), HasSubstr("missing key \"points\""));
  EXPECT_THAT(SceneRefusal("guide: 0 0 5 mm, input: tension", "input: tension"),
              HasSubstr("missing key \"guide\""));
}

TEST(SceneRefusal, WantsATableForActuators) {
  EXPECT_THAT(
      SceneRefusal("actuation: actuation.csv\n", ""),
      StartsWith("scene.yaml:1: missing key \"actuation\", got only softforce, name, body, "));
  EXPECT_THAT(SceneRefusal("actuation.csv", "inputs.csv"),
              StartsWith("scene.yaml:17: actuation: there is no file inputs.csv"));
}

TEST(SceneRefusal, WantsActuatorsForATable) {
  const std::string text = kSceneText;
  const size_t begin = text.find("actuators:");
  EXPECT_THAT(SceneRefusal(text.substr(begin, text.find("actuation:") - begin), ""),
              HasSubstr("actuation: got a table of inputs, but the scene has no actuators"));
}

TEST(SceneRefusal, WantsCamerasOrMotionCaptureAndNotBoth) {
  const std::string text = kSceneText;
  const std::string markers = "  type: apriltag\n  family: tag25h9\n  size: 14 mm\n";
  testing::WriteFile(testing::TempFolder() / "markers3d.csv", "");
  const std::string both = testing::Replaced(testing::Replaced(text, markers, ""),
                                             "cameras:", "measured: markers3d.csv\ncameras:");

  EXPECT_EQ(testing::Refusal([&] { LoadScene(testing::WriteScene(both)); }),
            "scene.yaml:30: cameras: got both \"cameras\" and \"measured\", expected one of them");
  EXPECT_THAT(SceneRefusal(text.substr(text.find("cameras:")), ""),
              HasSubstr("Or give \"measured\", points of motion capture."));
}

// kSceneText with motion capture, `section`, instead of cameras and tags.
std::filesystem::path MeasuredScene(const std::string& section) {
  const std::string text = kSceneText;
  const std::string markers = "  type: apriltag\n  family: tag25h9\n  size: 14 mm\n";
  testing::WriteFile(testing::TempFolder() / "take.csv", "");
  testing::WriteFile(testing::TempFolder() / "place.yaml", "softforce: 1\n");
  return testing::WriteScene(testing::Replaced(text.substr(0, text.find("cameras:")), markers, "") +
                             section);
}

TEST(SceneRefusal, ReadsWhatMotionCaptureNeeds) {
  const Scene scene = LoadScene(MeasuredScene(
      "measured: {file: take.csv, unit: cm, rate: 100 Hz, noise: 0.1 mm, labels: false, ignore: "
      "[wand]}\n"));

  ASSERT_TRUE(scene.measured.has_value());
  EXPECT_EQ(scene.measured->metres_per_unit, 1e-2);
  EXPECT_EQ(scene.measured->rate, 100);
  EXPECT_DOUBLE_EQ(scene.measured->noise, 1e-4);
  EXPECT_FALSE(scene.measured->labels);
  EXPECT_EQ(scene.measured->ignore.at(0), "wand");
  EXPECT_EQ(scene.markers.points[1].label, "7");  // its id
}

TEST(SceneRefusal, SaysWhatIsWrongWithMotionCapture) {
  const auto refusal = [](const std::string& section) {
    return testing::Refusal([&] { LoadScene(MeasuredScene(section)); });
  };

  EXPECT_THAT(refusal("measured: takes.csv\n"), HasSubstr("measured: there is no file takes.csv"));
  EXPECT_THAT(refusal("measured: {file: take.csv, noise: 0.1 N}\n"),
              HasSubstr("measured: noise: "));
  EXPECT_THAT(refusal("measured: {file: take.csv, units: mm}\n"), HasSubstr("units"));
  EXPECT_THAT(refusal("measured: {file: take.csv, rig: place.yaml, T_rig_robot: [[1, 0, 0, 0], [0, "
                      "1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n"),
              HasSubstr("got both \"rig\" and \"T_rig_robot\", expected one of them"));
}

TEST(SceneRefusal, KnowsThatMotionCaptureSeesNoTags) {
  const std::string text = kSceneText;
  testing::WriteFile(testing::TempFolder() / "take.csv", "");
  const std::string tags = text.substr(0, text.find("cameras:")) + "measured: take.csv\n";

  EXPECT_THAT(testing::Refusal([&] { LoadScene(testing::WriteScene(tags)); }),
              HasSubstr("markers: type: got apriltag, but points of motion capture are no tags"));
}

}  // namespace
}  // namespace softforce::scene
