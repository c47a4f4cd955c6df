#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using testing::kSceneText;
using testing::Replaced;
using testing::TempFolder;
using testing::WriteScene;

Scene LoadText(const std::string& text) { return LoadScene(WriteScene(text)); }

TEST(LoadScene, ReadsTheBodyInSi) {
  const Scene scene = LoadText(kSceneText);

  EXPECT_EQ(scene.file, TempFolder() / "scene.yaml");
  EXPECT_EQ(scene.name, "finger");
  EXPECT_EQ(scene.mesh.file, TempFolder() / "finger.msh");
  EXPECT_DOUBLE_EQ(scene.mesh.metres_per_unit, 1e-3);
  EXPECT_EQ(scene.mesh.order, 1);
  EXPECT_DOUBLE_EQ(scene.gravity.z(), -9.81);
  EXPECT_DOUBLE_EQ(scene.density, 1070);
  ASSERT_EQ(scene.fixed.size(), 2);
  EXPECT_TRUE(scene.fixed[0].box_max.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03)));
  EXPECT_EQ(scene.fixed[0].group, "");
  EXPECT_EQ(scene.fixed[1].group, "base");
}

TEST(LoadScene, ReadsAMaterialPerRegion) {
  const Scene scene = LoadText(kSceneText);

  ASSERT_EQ(scene.materials.size(), 2);
  EXPECT_DOUBLE_EQ(scene.materials.at("soft").youngs_modulus, 290e3);
  EXPECT_EQ(scene.materials.at("hard").model, fem::MaterialModel::kCorotational);
  EXPECT_DOUBLE_EQ(scene.materials.at("hard").poissons_ratio, 0.3);
}

TEST(LoadScene, GivesOneMaterialToTheWholeBody) {
  const std::string text =
      Replaced(kSceneText,
               "    soft: {model: neo_hookean, youngs_modulus: 290 kPa, poissons_ratio: 0.45}\n"
               "    hard: {model: corotational, youngs_modulus: 2 MPa, poissons_ratio: 0.3}",
               "    {model: neo_hookean, youngs_modulus: 290 kPa, poissons_ratio: 0.45}");

  const Scene scene = LoadText(text);

  ASSERT_EQ(scene.materials.size(), 1);
  EXPECT_EQ(scene.materials.at("").model, fem::MaterialModel::kNeoHookean);
}

TEST(LoadScene, ReadsActuatorsInTheirOrder) {
  const Scene scene = LoadText(kSceneText);

  ASSERT_EQ(scene.actuators.size(), 3);
  const Actuator& left = scene.actuators[0];
  EXPECT_EQ(left.input, ActuatorInput::kDisplacement);
  ASSERT_EQ(left.points.size(), 2);
  EXPECT_TRUE(left.points[1].isApprox(Eigen::Vector3d(0.01, 0, 0.02)));
  EXPECT_TRUE(left.guide.isApprox(Eigen::Vector3d(0, 0, 0.005)));
  EXPECT_DOUBLE_EQ(left.patch, 6e-3);
  EXPECT_EQ(scene.actuators[1].input, ActuatorInput::kTension);
  EXPECT_EQ(scene.actuators[2].type, ActuatorType::kPressure);
  EXPECT_EQ(scene.actuators[2].input, ActuatorInput::kPressure);
  EXPECT_EQ(scene.actuators[2].group, "cavity");
}

TEST(LoadScene, ReadsHowWellActuatorsAreKnown) {
  const auto with = [](const std::string& from, const std::string& to) {
    return LoadText(Replaced(kSceneText, from, to)).actuators;
  };
  EXPECT_EQ(LoadText(kSceneText).actuators[0].uncertainty, 0);
  EXPECT_DOUBLE_EQ(with("patch: 6 mm}", "uncertainty: 0.2 mm}")[0].uncertainty, 2e-4);
  EXPECT_DOUBLE_EQ(with("input: tension}", "input: tension, uncertainty: 0.1 N}")[1].uncertainty,
                   0.1);
  EXPECT_EQ(with("group: cavity}", "group: cavity, uncertainty: unknown}")[2].uncertainty,
            INFINITY);
}

TEST(LoadScene, ReadsMarkers) {
  const Markers markers = LoadText(kSceneText).markers;

  EXPECT_EQ(markers.type, MarkerType::kAprilTag);
  EXPECT_EQ(markers.family, "tag25h9");
  EXPECT_DOUBLE_EQ(markers.size, 14e-3);
  ASSERT_EQ(markers.points.size(), 2);
  EXPECT_EQ(markers.points[1].id, 7);
  EXPECT_TRUE(markers.points[1].position.isApprox(Eigen::Vector3d(0.03, 0.05, 0.01)));
}

TEST(LoadScene, ReadsTheThreeKindsOfDirection) {
  const Forces forces = LoadText(kSceneText).forces;

  EXPECT_FALSE(forces.known_locations);
  EXPECT_DOUBLE_EQ(forces.patch, 5e-3);
  ASSERT_EQ(forces.candidates.size(), 3);
  EXPECT_EQ(forces.candidates[0].direction, ForceDirection::kFree);
  EXPECT_EQ(forces.candidates[1].direction, ForceDirection::kNormal);
  EXPECT_EQ(forces.candidates[2].direction, ForceDirection::kFixed);
  EXPECT_TRUE(forces.candidates[2].fixed_direction.isApprox(Eigen::Vector3d(0, 0.6, -0.8)));
}

TEST(LoadScene, LeavesOutWhatIsOptional) {
  std::string text = Replaced(kSceneText, ", order: 1", "");
  text = Replaced(text, "  gravity: 0 0 -9.81 m/s^2\n  density: 1.07 g/cm^3\n", "");
  text = Replaced(text, "  patch: 5 mm\n", "");
  text = Replaced(text, text.substr(text.find("  fiducials")), "");
  text = Replaced(
      text, text.substr(text.find("actuators"), text.find("markers") - text.find("actuators")), "");

  const Scene scene = LoadText(text);

  EXPECT_EQ(scene.mesh.order, 2);
  EXPECT_TRUE(scene.gravity.isZero());
  EXPECT_EQ(scene.forces.patch, 0);
  EXPECT_TRUE(scene.actuators.empty());
  EXPECT_FALSE(scene.actuation_file.has_value());
  EXPECT_EQ(scene.actuation.At(1).size(), 0);
  EXPECT_TRUE(scene.cameras.fiducials.empty());
}

}  // namespace
}  // namespace softforce::scene
