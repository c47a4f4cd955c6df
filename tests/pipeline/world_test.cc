#include "softforce/pipeline/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "softforce/base/input_error.h"
#include "support/box_mesh.h"

namespace softforce::pipeline {
namespace {

std::string Refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

// The shipped scene, read anew for each test so that it may be changed.
scene::Scene Demo() {
  return scene::LoadScene(std::string(SOFTFORCE_SOURCE_DIR) +
                          "/datasets/sheet_two_weights/scene.yaml");
}

TEST(PlaceOnSurface, KeepsASmallOffset) {
  const mesh::TetMesh box = testing::MakeBox(2, 2, 2, {0.02, 0.02, 0.02});
  const mesh::Surface surface = mesh::ExtractSurface(box);

  const BodyPoint point = PlaceOnSurface(surface, box.nodes, {0.007, 0.012, 0.021}, "marker");

  EXPECT_LT((point.weights.Apply(box.nodes) - Eigen::Vector3d(0.007, 0.012, 0.02)).norm(), 1e-12);
  EXPECT_LT((point.offset - Eigen::Vector3d(0, 0, 0.001)).norm(), 1e-12);
}

TEST(PlaceOnSurface, RefusesAPlaceFarOffAndNamesTheNearest) {
  const mesh::TetMesh box = testing::MakeBox(2, 2, 2, {0.02, 0.02, 0.02});
  const mesh::Surface surface = mesh::ExtractSurface(box);

  EXPECT_THAT(Refusal([&] {
                PlaceOnSurface(surface, box.nodes, {0.01, 0.01, 0.025}, "marker 3");
              }),
              ::testing::AllOf(::testing::HasSubstr("marker 3"), ::testing::HasSubstr("5 mm off"),
                               ::testing::HasSubstr("(10 10 20) mm")));
}

TEST(BuildWorld, RaisesTheOrderAndHoldsTheCorners) {
  const World world = BuildWorld(Demo());
  EXPECT_EQ(world.mesh().order(), 2);
  EXPECT_EQ(world.markers.size(), 14u);
  EXPECT_EQ(world.sites.size(), 2u);
  for (const int node : world.solver->body().fixed_nodes) {
    const Eigen::Vector3d X = world.mesh().nodes.col(node);
    EXPECT_LT(std::min(X.x(), 0.2 - X.x()), 0.01 + 1e-9);
    EXPECT_LT(std::min(X.y(), 0.2 - X.y()), 0.01 + 1e-9);
  }
}

TEST(BuildWorld, LetsANormalForceOnlyPush) {
  scene::Scene scene = Demo();
  scene.forces.candidates[0].direction = scene::ForceDirection::kNormal;
  const World world = BuildWorld(scene);
  EXPECT_EQ(world.sites[0].lowest, 0);
  EXPECT_GT(world.sites[0].directions(2, 0), 0.99);  // into the sheet, from below
  EXPECT_EQ(world.sites[1].lowest, -INFINITY);
}

TEST(BuildWorld, LowersTheOrderWhenAsked) {
  scene::Scene scene = Demo();
  scene.mesh.order = 1;
  EXPECT_EQ(BuildWorld(scene).mesh().order(), 1);
}

TEST(BuildWorld, TakesASingleMarker) {
  scene::Scene scene = Demo();
  scene.markers.points.resize(1);
  EXPECT_TRUE(std::isfinite(BuildWorld(scene).marker_spacing));
}

TEST(BuildWorld, RefusesTwoMarkersAtOnePlace) {
  scene::Scene scene = Demo();
  scene.markers.points[5].position = scene.markers.points[2].position;
  EXPECT_THAT(Refusal([&] { BuildWorld(scene); }), ::testing::HasSubstr("ids 2 and 5"));
}

TEST(BuildWorld, RefusesAGroupThatTheMeshDoesNotHave) {
  scene::Scene scene = Demo();
  scene.fixed = {{"base", {}, {}}};
  EXPECT_THAT(Refusal([&] { BuildWorld(scene); }),
              ::testing::HasSubstr("no surface group \"base\""));
}

TEST(BuildWorld, RefusesAMaterialForARegionThatTheMeshDoesNotHave) {
  scene::Scene scene = Demo();
  scene.materials["skin"] = scene.materials.begin()->second;
  EXPECT_THAT(
      Refusal([&] { BuildWorld(scene); }),
      ::testing::AllOf(::testing::HasSubstr("\"skin\""), ::testing::HasSubstr("\"sheet\"")));
}

TEST(BuildWorld, RefusesAChamberThatIsNotClosed) {
  scene::Scene scene = Demo();
  scene.mesh.file = std::string(SOFTFORCE_SOURCE_DIR) + "/meshes/sheet.msh";  // has a group "top"
  scene::Actuator chamber;
  chamber.name = "belly";
  chamber.type = scene::ActuatorType::kPressure;
  chamber.group = "top";
  scene.actuators.push_back(chamber);
  EXPECT_THAT(Refusal([&] { BuildWorld(scene); }),
              ::testing::AllOf(::testing::HasSubstr("chamber \"belly\""),
                               ::testing::HasSubstr("not closed")));
}

TEST(BuildWorld, RefusesAChamberOfAnUnknownGroup) {
  scene::Scene scene = Demo();
  scene::Actuator chamber;
  chamber.name = "belly";
  chamber.type = scene::ActuatorType::kPressure;
  chamber.group = "cavity";
  scene.actuators.push_back(chamber);
  EXPECT_THAT(Refusal([&] { BuildWorld(scene); }),
              ::testing::AllOf(::testing::HasSubstr("actuators: \"belly\": group"),
                               ::testing::HasSubstr("no surface group \"cavity\"")));
}

scene::Actuator CableThrough(const Eigen::Vector3d& via) {
  scene::Actuator cable;
  cable.name = "left";
  cable.points = {{0.1, 0.1, 0.01}, via};
  cable.guide = {0.1, 0.3, 0.05};
  return cable;
}

TEST(BuildWorld, RefusesACableOutsideTheBody) {
  scene::Scene scene = Demo();
  scene.actuators.push_back(CableThrough({0.1, 0.15, 0.025}));
  EXPECT_THAT(Refusal([&] { BuildWorld(scene); }),
              ::testing::AllOf(::testing::HasSubstr("actuators: \"left\": points"),
                               ::testing::HasSubstr("15 mm off the body's surface")));
}

TEST(BuildWorld, LeadsACableThroughTheInsideOfTheBody) {
  scene::Scene scene = Demo();
  const Eigen::Vector3d inside(0.1, 0.15, 0.005);
  scene.actuators.push_back(CableThrough(inside));
  const World world = BuildWorld(scene);
  const fem::Cable& cable = world.solver->body().cables.at(0);
  EXPECT_LT((cable.points[1].Apply(world.mesh().nodes) - inside).norm(), 1e-12);  // m
}

}  // namespace
}  // namespace softforce::pipeline
