#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "acceptance/program.h"
#include "softforce/scene/rig_file.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/recording.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

// The scene of the shipped recording without its videos, and with a section "simulation" of these
// lines. The rig stands where the shipped truth says.
Folder SceneToSimulate(const std::string& name, const std::string& section) {
  const Folder dataset = Folder(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights";
  const Folder folder = testing::FreshFolder(name);
  for (const char* file : {"rig.yaml", "sheet.msh"}) {
    std::filesystem::copy(dataset / file, folder);
  }
  const auto truth = nlohmann::json::parse(testing::ReadText(dataset / "truth.json"));
  std::string T;
  for (int i = 0; i < 4; ++i) {
    auto row = truth["cameras"]["left"]["T_camera_robot"][i].get<std::vector<double>>();
    if (i < 3) row[3] *= 1e-3;  // mm
    T += fmt::format("      - [{}]\n", fmt::join(row, ", "));
  }
  testing::WriteText(folder / "scene.yaml", testing::ReadText(dataset / "scene.yaml") +
                                                "simulation:\n" + section +
                                                "  rig:\n    T_rig_robot:\n" + T);
  return folder;
}

testing::ProgramResult Simulate(const Folder& folder) {
  return testing::RunProgram(
      fmt::format("simulate '{0}/scene.yaml' --out '{0}/recording'", folder.string()));
}

TEST(SimulateCommand, MakesARecordingWhoseForcesAreFound) {
  const Folder folder = SceneToSimulate(
      "simulate_sheet",
      "  frames: 4\n"
      "  mesh: {file: fine.msh, unit: mm}\n"
      "  forces:\n"
      "    - {candidate: 0, history: [{time: 0 s, force: 0 0 0 N}, {time: 0.05 s, force: 0 0 -0.5 "
      "N}]}\n"
      "    - {candidate: 1, history: [{time: 0 s, force: 0 0 0 N}, {time: 0.05 s, force: 0 0 -0.3 "
      "N}]}\n");
  testing::WriteText(folder / "sheet.geo",
                     "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 200, 200, 10};\n");
  const testing::ProgramResult meshed = testing::RunProgram(
      fmt::format("mesh '{0}/sheet.geo' '{0}/fine.msh' --size '8 mm'", folder.string()));
  ASSERT_EQ(meshed.exit_code, 0) << meshed.errors;

  const testing::ProgramResult simulated = Simulate(folder);
  ASSERT_EQ(simulated.exit_code, 0) << simulated.errors;
  EXPECT_NE(simulated.output.find("4 frames"), std::string::npos) << simulated.output;
  const testing::ProgramResult run = testing::RunProgram(fmt::format(
      "run '{0}/recording/scene.yaml' --out '{0}/results' --no-overlay", folder.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const auto& row : testing::ReadTable(folder / "results/forces.csv")) {
    if (std::stoi(row.at("frame")) < 2) continue;
    const double truth = row.at("candidate") == "0" ? 0.5 : 0.3;  // N
    // The run's mesh is some 2 % stiffer than the truth's, and the rig's place is found anew.
    EXPECT_NEAR(std::stod(row.at("norm_N")), truth, 0.03 * truth) << row.at("frame");
  }
  const testing::ProgramResult compared = testing::RunCommand(
      fmt::format("'{}/scripts/compare_with_truth' '{}/results' '{}/recording/truth.json' --hold "
                  "2:3 --max-error 3",
                  SOFTFORCE_SOURCE_DIR, folder.string(), folder.string()));
  EXPECT_EQ(compared.exit_code, 0) << compared.output << compared.errors;
}

// The first pictures of a recording, all cameras.
std::vector<cv::Mat> FirstPictures(const Folder& folder) {
  vision::Recording recording(scene::LoadRig(folder / "rig.yaml"),
                              {{"left", folder / "left.mp4"}, {"right", folder / "right.mp4"}});
  return recording.Next().value().pictures;
}

// The shipped recording was made by another solver and another renderer.
TEST(SimulateCommand, ShowsTheSheetAsTheShippedRecordingDoes) {
  const Folder folder = SceneToSimulate("simulate_shipped", "  frames: 1\n  mesh: {refine: 0}\n");
  const testing::ProgramResult simulated = Simulate(folder);
  ASSERT_EQ(simulated.exit_code, 0) << simulated.errors;

  const auto ours = FirstPictures(folder / "recording");
  const auto theirs = FirstPictures(Folder(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights");

  for (int c = 0; c < 2; ++c) {
    const auto dots = vision::DetectDots(ours[c]);
    const auto shipped = vision::DetectDots(theirs[c]);
    ASSERT_EQ(dots.size(), 14u);
    ASSERT_GE(shipped.size(), 14u);
    double squares = 0;
    for (const vision::Dot& dot : dots) {
      double nearest = 1e9;
      for (const vision::Dot& other : shipped) {
        nearest = std::min(nearest, (other.centroid - dot.centroid).squaredNorm());
      }
      squares += nearest;
    }
    // px, of the 2-D distance: noise and compression of both videos.
    EXPECT_LT(std::sqrt(squares / 14), 0.05) << c;
    EXPECT_NEAR(cv::mean(ours[c])[0], cv::mean(theirs[c])[0], 10) << c;  // grey levels; alike
  }
}

// A section that is refused, and what is named.
struct Refused {
  const char* name;
  const char* section;
  const char* named;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class RefusedSimulation : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedSimulation, EndsWithOneMessageAndNoRecording) {
  const Folder folder =
      SceneToSimulate(std::string("simulate_bad_") + GetParam().name, GetParam().section);

  const testing::ProgramResult run = Simulate(folder);

  EXPECT_EQ(run.exit_code, 2) << run.output << run.errors;
  EXPECT_EQ(run.errors.rfind("softforce: ", 0), 0u) << run.errors;
  EXPECT_EQ(run.errors.find("softforce: ", 1), std::string::npos) << run.errors;
  EXPECT_NE(run.errors.find(GetParam().named), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "recording/scene.yaml"));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedSimulation,
    ::testing::Values(
        Refused{"UnknownKey", "  framse: 4\n", "framse"},
        Refused{"NoSuchCandidate", "  forces: [{candidate: 9, history: []}]\n", "id 9"},
        Refused{"ForceWithoutUnit",
                "  forces: [{candidate: 0, history: [{time: 0 s, force: 0 0 1}]}]\n", "force"},
        Refused{"TooFine", "  mesh: {refine: 3}\n", "refine"},
        Refused{"NoSuchMesh", "  mesh: {file: none.msh, unit: mm}\n", "none.msh"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(SimulateCommand, ExplainsItself) {
  const testing::ProgramResult help = testing::RunProgram("simulate --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.output.find("--out"), std::string::npos) << help.output;
}

}  // namespace
}  // namespace softforce
