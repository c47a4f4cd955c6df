#include <gtest/gtest.h>

#include <filesystem>

#include "softforce/mesh/write_mesh.h"
#include "softforce/pipeline/world.h"
#include "support/hollow_box.h"

namespace softforce::pipeline {
namespace {

constexpr double kHalf = 0.02;  // m

// The shipped scene with another body: a hollow box whose inside is the surface group "cavity",
// held at its lower face.
scene::Scene ChamberScene() {
  mesh::TetMesh box = testing::MakeHollowBox(2, kHalf);
  const fem::Chamber hollow = testing::HollowOf(box, kHalf);
  for (Eigen::Index t = 0; t < hollow.walls.cols(); ++t) {
    box.surface_groups["cavity"].push_back(
        {hollow.walls(0, t), hollow.walls(1, t), hollow.walls(2, t)});
  }
  // Of its own: tests run beside each other.
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) /
      (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".msh");
  mesh::WriteMesh(file, box, 1e-3);

  scene::Scene scene = scene::LoadScene(std::string(SOFTFORCE_SOURCE_DIR) +
                                        "/datasets/sheet_two_weights/scene.yaml");
  scene.mesh.file = file;
  scene.markers.points = {{0, {0, 0, kHalf}}};
  scene.forces.candidates.resize(1);
  scene.forces.candidates[0].position = {0.01, 0, kHalf};
  scene.fixed.resize(1);
  scene.fixed[0].group = "";
  scene.fixed[0].box_min = {-1, -1, -kHalf};
  scene.fixed[0].box_max = {1, 1, -kHalf};
  return scene;
}

scene::Actuator Chamber() {
  scene::Actuator chamber;
  chamber.name = "belly";
  chamber.type = scene::ActuatorType::kPressure;
  chamber.input = scene::ActuatorInput::kPressure;
  chamber.group = "cavity";
  return chamber;
}

scene::Actuator Cable() {
  scene::Actuator cable;
  cable.name = "side";
  cable.input = scene::ActuatorInput::kTension;
  cable.points = {{kHalf, 0, 0.005}};
  cable.guide = {0.1, 0, 0};
  return cable;
}

TEST(Actuators, AChamberOfTheSceneBlowsUpTheBody) {
  scene::Scene scene = ChamberScene();
  scene.actuators = {Chamber()};
  const World world = BuildWorld(scene);
  ASSERT_EQ(world.solver->body().chambers.size(), 1u);

  fem::Equilibrium state = world.solver->AtRest();
  fem::LoadCase load = state.load;
  load.actuation.pressures = {10e3};
  ASSERT_TRUE(world.solver->Solve(load, &state).ok());

  const Eigen::Vector3d top = world.markers[0].weights.Apply(state.u);
  EXPECT_GT(top.z(), 1e-4);                         // m; upwards, as the box is held below
  EXPECT_LT(top.head<2>().norm(), 0.05 * top.z());  // the cells are not quite symmetric
}

TEST(Actuators, OfTwoKindsEachGetTheirOwnInput) {
  scene::Scene scene = ChamberScene();
  scene.actuators = {Cable(), Chamber()};
  scene.actuation.time_s = {0, 1};
  scene.actuation.inputs.resize(2, 2);
  scene.actuation.inputs << 0, 0, 2, 10e3;

  const fem::Actuation at_half = ActuationAt(scene, 0.5);

  ASSERT_EQ(at_half.cables.size(), 1u);
  EXPECT_EQ(at_half.cables[0].input, fem::CableInput::kTension);
  EXPECT_DOUBLE_EQ(at_half.cables[0].value, 1);  // N
  ASSERT_EQ(at_half.pressures.size(), 1u);
  EXPECT_DOUBLE_EQ(at_half.pressures[0], 5e3);  // Pa
}

}  // namespace
}  // namespace softforce::pipeline
