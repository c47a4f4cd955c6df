#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "acceptance/program.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;
using Row = std::map<std::string, std::string>;

const Folder kShared = Folder(SOFTFORCE_SOURCE_DIR) / "../shared/recordings";

Eigen::Vector3d Read(Row& row, const char* prefix, const char* suffix) {
  const auto value = [&](const char* axis) {
    return std::stod(row[prefix + std::string(axis) + suffix]);
  };
  return {value("x"), value("y"), value("z")};
}

Eigen::Vector3d FromJson(const nlohmann::json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

// The largest errors in frames from `first_held` on, beside the truth.
struct Errors {
  double place_mm = 0, norm = 0, vector = 0;  // forces as shares
  std::set<std::string> identities;
  int frames = 0;
};

Errors Compare(const Folder& results, const Folder& truth_file, int first_held) {
  const auto truth = nlohmann::json::parse(testing::ReadText(truth_file));
  Errors errors;
  std::map<int, int> found;
  for (Row& row : testing::ReadTable(results / "forces.csv")) {
    const int frame = std::stoi(row["frame"]);
    if (frame < first_held) continue;
    EXPECT_EQ(row["status"], "ok") << "frame " << frame;
    if (row["status"] != "ok") continue;
    ++found[frame];
    errors.identities.insert(row["force"]);
    const Eigen::Vector3d place = Read(row, "rest_", "_mm"), force = Read(row, "f", "_N");
    const nlohmann::json* nearest = nullptr;
    for (const auto& one : truth["frames"][frame]["forces"]) {
      if (nearest == nullptr || (FromJson(one["at_rest"]) - place).norm() <
                                    (FromJson((*nearest)["at_rest"]) - place).norm()) {
        nearest = &one;
      }
    }
    const Eigen::Vector3d true_force = FromJson((*nearest)["F"]);
    errors.place_mm = std::max(errors.place_mm, (FromJson((*nearest)["at_rest"]) - place).norm());
    errors.norm = std::max(errors.norm, std::abs(force.norm() / true_force.norm() - 1));
    errors.vector = std::max(errors.vector, (force - true_force).norm() / true_force.norm());
  }
  for (const auto& [frame, forces] : found) {
    EXPECT_EQ(forces, static_cast<int>(truth["frames"][frame]["forces"].size()))
        << "frame " << frame;
  }
  errors.frames = static_cast<int>(found.size());
  std::cout << fmt::format(
      "{} frames: places within {:.2f} mm, norms within {:.2f} %, vectors within {:.2f} %\n",
      errors.frames, errors.place_mm, 100 * errors.norm, 100 * errors.vector);
  return errors;
}

Errors RunUnknown(const Folder& recording, const Folder& scene, const std::string& name,
                  int first_held, const std::string& frames = "--every 2") {
  const Folder out = testing::FreshFolder(name);
  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}' --no-overlay {}", scene.string(), out.string(), frames));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  return Compare(out, recording / "truth.json", first_held);
}

// Copies of the recordings. The moduli are those that `identify` finds for these meshes, see
// docs/identify.md.
//
// Twelve candidates on a grid; the weights hang between them.
Folder SheetScene() {
  const Folder scene = testing::FreshFolder("unknown_sheet");
  std::filesystem::copy(kShared / "sheet_two_weights", scene,
                        std::filesystem::copy_options::recursive);
  const Folder file = scene / "scene_unknown_places.yaml";
  testing::Edit(file, "290 kPa", "285.3 kPa");
  return file;
}

// The weight hangs at (0, 0, 96) mm, under the platform; none of the candidates is there.
Folder RobotScene() {
  const Folder scene = testing::FreshFolder("unknown_robot");
  std::filesystem::copy(kShared / "robot_tip_weight", scene,
                        std::filesystem::copy_options::recursive);
  const Folder file = scene / "scene.yaml";
  testing::Edit(file, "known: true", "known: false");
  testing::Edit(file, "220 kPa", "216.1 kPa");
  testing::Edit(file, "- {id: 0, position: 0 0 96 mm, direction: [0.000000, 0.000000, -1.000000]}",
                "- {id: 0, position: 6 -5 96 mm, direction: free}\n"
                "    - {id: 1, position: -6 5 96 mm, direction: free}\n"
                "    - {id: 2, position: 39.802551 0 76.916357 mm, direction: free}\n"
                "    - {id: 3, position: 0 39.802551 76.916357 mm, direction: free}");
  return file;
}

void ExpectTwoWeights(const Errors& errors) {
  EXPECT_EQ(errors.frames, 5);
  EXPECT_EQ(errors.identities.size(), 2u) << "one identity each, all the time";
  EXPECT_LT(errors.place_mm, 3);   // the aim
  EXPECT_LT(errors.norm, 0.03);    // the aim
  EXPECT_LT(errors.vector, 0.12);  // sideways a flat sheet hardly moves: sd 0.03 N of 0.56 N
}

void ExpectTipWeight(const Errors& errors) {
  EXPECT_EQ(errors.frames, 3);
  EXPECT_EQ(errors.identities.size(), 1u);
  EXPECT_LT(errors.place_mm, 3);   // the aim
  EXPECT_LT(errors.vector, 0.03);  // the aim
}

TEST(UnknownPlaces, OfTwoWeightsOnTheSheet) {
  if (!std::filesystem::exists(kShared)) GTEST_SKIP() << "no recordings at " << kShared;
  ExpectTwoWeights(
      RunUnknown(kShared / "sheet_two_weights", SheetScene(), "unknown_sheet_results", 20));
}

TEST(UnknownPlaces, OfTheWeightAtTheRobotsTip) {
  if (!std::filesystem::exists(kShared)) GTEST_SKIP() << "no recordings at " << kShared;
  ExpectTipWeight(
      RunUnknown(kShared / "robot_tip_weight", RobotScene(), "unknown_robot_results", 24));
}

// The first frame has the whole load: markers are 11 and 26 mm from where they were without.
TEST(UnknownPlaces, OfABodyThatIsLoadedFromTheFirstFrameOn) {
  if (!std::filesystem::exists(kShared)) GTEST_SKIP() << "no recordings at " << kShared;
  ExpectTwoWeights(RunUnknown(kShared / "sheet_two_weights", SheetScene(), "loaded_sheet_results",
                              20, "--frames 20:25"));
  ExpectTipWeight(RunUnknown(kShared / "robot_tip_weight", RobotScene(), "loaded_robot_results", 24,
                             "--frames 24:27"));
}

}  // namespace
}  // namespace softforce
