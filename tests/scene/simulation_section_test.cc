#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene/temp_scene.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/recorded_scene.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

using ::testing::HasSubstr;
using testing::kSceneText;
using testing::TempFolder;
using testing::WriteFile;
using testing::WriteScene;

const char* const kSection = R"(simulation:
  seed: 9
  frames: 12
  rate: 25 Hz
  mesh: {file: fine.msh, unit: cm, order: 1, refine: 1}
  material: {model: corotational, youngs_modulus: 100 kPa, poissons_ratio: 0.4}
  forces:
    - {candidate: 1, history: [{time: 0 s, force: 0 0 0 N}, {time: 2 s, force: 0 -4 0 N}]}
    - {position: 10 20 30 mm, history: [{time: 1 s, force: 1 2 3 mN}]}
  actuation: told.csv
  actuator_offsets: {left: 0.5 mm, right: 10 mN, chamber: 200 Pa}
  registration: {translation: 1 2 3 mm, rotation: 0 0 90 deg}
  markers: {noise: 0.2 mm, hidden: 0.1, dropouts: [{ids: [7], from: 0.1 s, until: 0.2 s}]}
  rig: {position: 0 0 500 mm, looks_at: 0 0 0 mm}
  pictures:
    blur_px: 0.5
    noise_grey: 2
    contrast: 0.8
    brightness_grey: 10
    light_gradient: [0.1, -0.2]
    light: [0, 1, 1]
    tag_up: [1, 0, 0]
    strewn_decoys: 3
    decoys: [1 2 3 mm]
    occluders: [{position: 0 0 90 mm, to: 9 0 90 mm, from: 0 s, until: 1 s, reach: 0 50 0 mm, diameter: 10 mm, grey: 30}]
    cable_diameter: 0.5 mm
)";

Simulation Read(SceneFiles files = SceneFiles::kToSimulate) {
  WriteFile(TempFolder() / "fine.msh", "");
  WriteFile(TempFolder() / "told.csv", "time_s,chamber_kPa,left_mm,right_N\n0,1,2,3\n");
  return LoadScene(WriteScene(std::string(kSceneText) + kSection), files).simulation.value();
}

TEST(SimulationSection, ReadsBodyAndLoads) {
  const Simulation simulation = Read();

  EXPECT_EQ(simulation.seed, 9u);
  EXPECT_EQ(simulation.frames, 12);
  EXPECT_EQ(simulation.rate, 25);
  EXPECT_EQ(simulation.mesh_file, TempFolder() / "fine.msh");
  EXPECT_DOUBLE_EQ(simulation.metres_per_unit, 0.01);
  EXPECT_EQ(simulation.order, 1);
  EXPECT_EQ(simulation.refine, 1);
  EXPECT_EQ(simulation.materials.at("").model, fem::MaterialModel::kCorotational);
  ASSERT_EQ(simulation.forces.size(), 2u);
  EXPECT_EQ(simulation.forces[0].name, "F1");
  EXPECT_TRUE(simulation.forces[0].position.isApprox(Eigen::Vector3d(0.065, 0.14, 0.01)));
  EXPECT_TRUE(simulation.forces[0].At(0.5).isApprox(Eigen::Vector3d(0, -1, 0)));
  EXPECT_TRUE(simulation.forces[0].At(9).isApprox(Eigen::Vector3d(0, -4, 0)));
  EXPECT_EQ(simulation.forces[1].name, "P1");
  EXPECT_TRUE(simulation.forces[1].At(0).isApprox(Eigen::Vector3d(1e-3, 2e-3, 3e-3)));
  EXPECT_DOUBLE_EQ(simulation.actuation.value().At(0)(0), 2e-3);  // m; of the cable "left"
  EXPECT_DOUBLE_EQ(simulation.actuator_offsets.at("left"), 5e-4);
  EXPECT_DOUBLE_EQ(simulation.actuator_offsets.at("right"), 0.01);
  EXPECT_DOUBLE_EQ(simulation.actuator_offsets.at("chamber"), 200);
  EXPECT_TRUE((simulation.T_robot_mesh * Eigen::Vector3d(0.01, 0, 0))
                  .isApprox(Eigen::Vector3d(0.001, 0.012, 0.003)));
}

TEST(SimulationSection, ReadsWhatIsSeen) {
  const Simulation simulation = Read();

  EXPECT_DOUBLE_EQ(simulation.markers.noise, 2e-4);
  EXPECT_EQ(simulation.markers.hidden_share, 0.1);
  ASSERT_EQ(simulation.markers.dropouts.size(), 1u);
  EXPECT_EQ(simulation.markers.dropouts[0].markers, std::vector<int>{1});  // id 7 is the second
  EXPECT_EQ(simulation.stand.value().position.z(), 0.5);
  EXPECT_TRUE(simulation.pictures);
  EXPECT_EQ(simulation.picture.blur, 0.5);
  EXPECT_EQ(simulation.picture.noise, 2);
  EXPECT_EQ(simulation.picture.contrast, 0.8);
  EXPECT_EQ(simulation.picture.brightness, 10);
  EXPECT_EQ(simulation.picture.light_gradient, Eigen::Vector2d(0.1, -0.2));
  EXPECT_TRUE(simulation.light_given);
  EXPECT_EQ(simulation.tag_up, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(simulation.strewn_decoys, 3);
  ASSERT_EQ(simulation.decoys.size(), 1u);
  ASSERT_EQ(simulation.occluders.size(), 1u);
  EXPECT_DOUBLE_EQ(simulation.occluders[0].end.x(), 0.009);
  EXPECT_DOUBLE_EQ(simulation.occluders[0].reach.y(), 0.05);
  EXPECT_EQ(simulation.occluders[0].grey, 30);
  EXPECT_DOUBLE_EQ(simulation.cable_diameter, 5e-4);
}

TEST(SimulationSection, DoesNotNeedItsFilesForARunNorTheRecordingForASimulation) {
  const std::filesystem::path file = WriteScene(std::string(kSceneText) + kSection);
  EXPECT_NO_THROW(LoadScene(file, SceneFiles::kAll));
  EXPECT_THROW(LoadScene(file, SceneFiles::kToSimulate), base::InputError);

  const std::filesystem::path plain = WriteScene(kSceneText);
  std::filesystem::remove(TempFolder() / "left.mp4");
  EXPECT_NO_THROW(LoadScene(plain, SceneFiles::kToSimulate));
  EXPECT_THROW(LoadScene(plain, SceneFiles::kAll), base::InputError);
}

TEST(SimulationSection, ReadsATableOfForces) {
  WriteFile(TempFolder() / "loads.csv", "2_z_N,time_s,0_x_N\n0,0,0\n-2,1,4\n");
  const auto forces =
      LoadScene(WriteScene(std::string(kSceneText) + "simulation: {forces: loads.csv}\n"),
                SceneFiles::kToSimulate)
          .simulation.value()
          .forces;

  ASSERT_EQ(forces.size(), 2u);
  EXPECT_EQ(forces[0].name, "F0");
  EXPECT_EQ(forces[0].At(0.5), Eigen::Vector3d(2, 0, 0));
  EXPECT_EQ(forces[1].name, "F2");
  EXPECT_EQ(forces[1].At(0.5), Eigen::Vector3d(0, 0, -1));
}

// A line of a section that is refused, and what the message says.
struct Refused {
  const char* name;
  const char* section;
  const char* said;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class RefusedSection : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedSection, IsNamed) {
  const auto file =
      WriteScene(std::string(kSceneText) + "simulation: {" + GetParam().section + "}\n");
  try {
    LoadScene(file);
    FAIL() << "it was accepted";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().said));
    EXPECT_THAT(error.what(), HasSubstr("scene.yaml:"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedSection,
    ::testing::Values(
        Refused{"UnknownKey", "sead: 1", "unknown key"},
        Refused{"NoFrames", "frames: 0", "at least 1"},
        Refused{"RateWithoutUnit", "rate: 30", "rate"},
        Refused{"MeshWithoutUnit", "mesh: {file: fine.msh}", "missing key \"unit\""},
        Refused{"Order", "mesh: {order: 3}", "order"},
        Refused{"ForceNowhere", "forces: [{history: [{time: 0 s, force: 0 0 1 N}]}]", "neither"},
        Refused{"ForceAtTwoPlaces",
                "forces: [{candidate: 0, position: 1 2 3 mm, history: [{time: 0 s, force: 0 0 1 "
                "N}]}]",
                "both"},
        Refused{"TimesNotAscending",
                "forces: [{candidate: 0, history: [{time: 1 s, force: 0 0 1 N}, {time: 1 s, force: "
                "0 0 1 N}]}]",
                "ascending"},
        Refused{"NoHistory", "forces: [{candidate: 0, history: []}]", "empty list"},
        Refused{"UnknownCandidate", "forces: [{candidate: 8, history: []}]", "no candidate"},
        Refused{"CandidateTwice",
                "forces: [{candidate: 0, history: [{time: 0 s, force: 0 0 1 N}]}, {candidate: 0, "
                "history: [{time: 0 s, force: 0 0 1 N}]}]",
                "given twice"},
        Refused{"UnknownActuator", "actuator_offsets: {middle: 1 mm}", "middle"},
        Refused{"OffsetOfAnotherKind", "actuator_offsets: {left: 1 N}", "left"},
        Refused{"HiddenShare", "markers: {hidden: 2}", "between 0 and 1"},
        Refused{"UnknownMarker", "markers: {dropouts: [{ids: [1]}]}", "no marker has the id 1"},
        Refused{"DropoutBackwards", "markers: {dropouts: [{from: 2 s, until: 1 s}]}",
                "ends before it begins"},
        Refused{"RigWithoutAim", "rig: {position: 0 0 1 m}", "looks_at"},
        Refused{"Blur", "pictures: {blur_px: -1}", "between 0 and 10 px"},
        Refused{"OccluderWithoutEnd",
                "pictures: {occluders: [{position: 0 0 0 mm, to: 1 0 0 mm, diameter: 1 mm}]}",
                "until"},
        Refused{"OccluderTooLight",
                "pictures: {occluders: [{position: 0 0 0 mm, diameter: 9 mm, grey: 256}]}",
                "from 0 to 255"},
        Refused{"OccluderWithoutSize", "pictures: {occluders: [{position: 0 0 0 mm}]}",
                "diameter"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(RecordedScene, NamesItsOwnFilesAndKeepsTheRest) {
  const auto original = WriteScene(std::string(kSceneText) + kSection);
  RecordedFiles files{"finger.msh",
                      "rig.yaml",
                      "actuation.csv",
                      {{"left", "left.mp4"}, {"right", "right.mp4"}},
                      ""};
  WriteFile(TempFolder() / "right.mp4", "");
  const auto copy = TempFolder() / "copy.yaml";

  SaveRecordedScene(original, files, copy);
  const Scene scene = LoadScene(copy);

  EXPECT_FALSE(scene.simulation);
  EXPECT_EQ(scene.cameras.sources.at("right"), (TempFolder() / "right.mp4").string());
  EXPECT_EQ(scene.markers.points.size(), 2u);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.actuators.size(), 3u);
  EXPECT_EQ(scene.cameras.fiducials.size(), 1u);
}

}  // namespace
}  // namespace softforce::scene
