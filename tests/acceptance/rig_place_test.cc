#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "acceptance/program.h"
#include "softforce/scene/place_rig.h"
#include "softforce/scene/rig_file.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;
using ::testing::HasSubstr;
using testing::ProgramResult;

// A copy of the demo; its scene names another rig file, and perhaps no fiducials.
Folder Demo(const std::string& name, const std::string& rig = "rig.yaml") {
  const Folder demo = testing::CopyOfDemo(name);
  testing::Edit(demo / "scene.yaml", "rig: rig.yaml", "rig: " + rig);
  return demo;
}

void DropFiducials(const Folder& demo) {
  const std::string scene = testing::ReadText(demo / "scene.yaml");
  testing::WriteText(demo / "scene.yaml", scene.substr(0, scene.find("  fiducials:")));
}

ProgramResult RunScene(const Folder& demo) {
  return testing::RunProgram(fmt::format("run '{}' --out '{}' --no-overlay --frames 0:3",
                                         (demo / "scene.yaml").string(),
                                         (demo / "results").string()));
}

ProgramResult Register(const Folder& demo, const std::string& options) {
  return testing::RunProgram(
      fmt::format("register '{}' {}", (demo / "scene.yaml").string(), options));
}

void Convert(const Folder& demo, const std::string& arguments) {
  const ProgramResult result =
      testing::RunProgram(fmt::format("rig '{}' {}", (demo / "rig.yaml").string(), arguments));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
}

// N, of the force in the last frame.
double SdOfForce(const Folder& demo) {
  return std::stod(testing::ReadTable(demo / "results/forces.csv").back().at("sd_z_N"));
}

TEST(RigPlace, HowSureItIsReachesTheForces) {
  const Folder demo = Demo("rig_place_forces");
  ASSERT_EQ(Register(demo, "--from markers --in-place").exit_code, 0);
  DropFiducials(demo);
  scene::RigPlace place;
  const camera::Rig registered = scene::LoadRig(demo / "rig.yaml");
  place.T_rig_robot = *registered.T_rig_robot;
  EXPECT_GT(registered.T_rig_robot_covariance.diagonal().minCoeff(), 0);
  const auto sd_with = [&](const geometry::Matrix6d& covariance) {
    place.covariance = covariance;
    scene::WritePlacedRig(demo / "rig.yaml", place, demo / "rig.yaml");
    const ProgramResult run = RunScene(demo);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return SdOfForce(demo);
  };

  const double exact = sd_with(geometry::Matrix6d::Zero());
  const double uncertain = sd_with(400 * registered.T_rig_robot_covariance);
  const double found = sd_with(registered.T_rig_robot_covariance);

  EXPECT_GT(found, exact);
  EXPECT_GT(uncertain, found);
  const auto summary = nlohmann::json::parse(testing::ReadText(demo / "results/summary.json"));
  EXPECT_EQ(summary["registration"]["from"], "rig_file");
  EXPECT_NEAR(summary["registration"]["sd_translation_mm"][2],
              1e3 * std::sqrt(registered.T_rig_robot_covariance(2, 2)), 1e-12);  // rounding
}

TEST(RigPlace, RegisteringInPlaceKeepsTheStatisticsOfTheCalibration) {
  const Folder demo = Demo("rig_place_statistics");
  scene::RigStatistics statistics;
  statistics.board = "chessboard:9x6,square=25mm";
  statistics.views = 14;
  statistics.cameras = {{"left", 14, 756, 0.2}, {"right", 13, 700, 0.3}};
  statistics.parameters = {"left: fx", "right: fx"};
  statistics.covariance = (Eigen::Matrix2d() << 0.16, -1e-5, -1e-5, 1.0 / 3e9).finished();
  scene::SaveRig(scene::LoadRig(demo / "rig.yaml"), demo / "rig.yaml", statistics);
  const std::string before = testing::ReadText(demo / "rig.yaml");

  ASSERT_EQ(Register(demo, "--from fiducials --in-place").exit_code, 0);

  EXPECT_THAT(testing::ReadText(demo / "rig.yaml"), HasSubstr(before));
  EXPECT_EQ(scene::LoadRigStatistics(demo / "rig.yaml")->covariance, statistics.covariance);
  EXPECT_TRUE(scene::LoadRig(demo / "rig.yaml").T_rig_robot.has_value());
}

TEST(RigPlace, ARunRefusesADamagedCovariance) {
  const Folder demo = Demo("rig_place_damaged");
  DropFiducials(demo);
  geometry::Matrix6d covariance = 1e-8 * geometry::Matrix6d::Identity();
  scene::RigPlace place;
  place.covariance = covariance;
  scene::WritePlacedRig(demo / "rig.yaml", place, demo / "rig.yaml");
  testing::Edit(demo / "rig.yaml", "[0, 1e-08, 0, 0, 0, 0]", "[0, -1e-08, 0, 0, 0, 0]");

  const ProgramResult run = RunScene(demo);

  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, HasSubstr("T_rig_robot_covariance[1]: got the variance -1e-08"));
  EXPECT_THAT(run.errors, HasSubstr("softforce register writes it"));
}

// Rig files of other programs, named in a scene as they are.
class OtherFormat : public ::testing::TestWithParam<const char*> {
 protected:
  Folder DemoWithIt(const std::string& name) const {
    const Folder demo = Demo(fmt::format("rig_place_{}_{}", name, GetParam()), "other.yaml");
    Convert(demo, fmt::format("-o '{}' --format {}", (demo / "other.yaml").string(), GetParam()));
    return demo;
  }
};

TEST_P(OtherFormat, ServesARunWithFiducials) {
  const Folder demo = DemoWithIt("fiducials");
  const ProgramResult run = RunScene(demo);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
}

TEST_P(OtherFormat, IsRefusedByARunWithoutFiducialsInOneSentence) {
  const Folder demo = DemoWithIt("bare");
  DropFiducials(demo);
  const ProgramResult run = RunScene(demo);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, HasSubstr("no T_rig_robot in "));
  EXPECT_THAT(run.errors, HasSubstr("softforce register"));
}

TEST_P(OtherFormat, IsRegisteredIntoARigOfOursThatARunTakes) {
  const Folder demo = DemoWithIt("registered");
  const ProgramResult result =
      Register(demo, fmt::format("-o '{}'", (demo / "placed.yaml").string()));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  DropFiducials(demo);
  testing::Edit(demo / "scene.yaml", "rig: other.yaml", "rig: placed.yaml");
  const ProgramResult run = RunScene(demo);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
}

TEST_P(OtherFormat, IsNotReplacedInPlace) {
  const Folder demo = DemoWithIt("in_place");
  const std::string before = testing::ReadText(demo / "other.yaml");
  const ProgramResult result = Register(demo, "--in-place");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("which has no place for T_rig_robot"));
  EXPECT_THAT(result.errors, HasSubstr("-o rig.yaml"));
  EXPECT_EQ(testing::ReadText(demo / "other.yaml"), before);
}

INSTANTIATE_TEST_SUITE_P(Formats, OtherFormat, ::testing::Values("opencv", "kalibr"),
                         [](const auto& instance) { return std::string(instance.param); });

// ROS has a file for each camera, and a scene names one.
TEST(RigPlace, AFileOfRosIsOneCamera) {
  const Folder demo = Demo("rig_place_ros", "ros/left.yaml");
  Convert(demo, fmt::format("-o '{}' --format ros", (demo / "ros").string()));
  const ProgramResult both = RunScene(demo);
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.errors, HasSubstr("\"right\""));
  EXPECT_EQ(Register(demo, "--in-place").exit_code, 2);

  testing::Edit(demo / "scene.yaml", "{left: left.mp4, right: right.mp4}", "{left: left.mp4}");
  const ProgramResult one = RunScene(demo);
  EXPECT_EQ(one.exit_code, 0) << one.errors;
}

}  // namespace
}  // namespace softforce
