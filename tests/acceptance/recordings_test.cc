#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "acceptance/program.h"

namespace softforce {
namespace {

// A recording with truth, and how large the mean force error over its hold phase may be (per cent).
// The physics are CalculiX's on a mesh several times finer, which the given meshes are too stiff
// against: see docs/accuracy.md.
struct RecordingCase {
  const char* name;
  const char* hold;
  double max_error;
};

void PrintTo(const RecordingCase& recording, std::ostream* out) { *out << recording.name; }

class EveryRecording : public ::testing::TestWithParam<RecordingCase> {};

TEST_P(EveryRecording, GivesForcesWithinItsBound) {
  const RecordingCase& recording = GetParam();
  const std::filesystem::path folder =
      std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings" / recording.name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recording at " << folder;
  const std::filesystem::path out = testing::FreshFolder(recording.name);

  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}'", (folder / "scene.yaml").string(), out.string()));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const testing::ProgramResult comparison = testing::RunCommand(fmt::format(
      "'{}/scripts/compare_with_truth' '{}' '{}' --hold {} --max-error {}", SOFTFORCE_SOURCE_DIR,
      out.string(), (folder / "truth.json").string(), recording.hold, recording.max_error));

  std::cout << recording.name << ", at most " << recording.max_error << " % allowed:\n"
            << comparison.output;
  EXPECT_EQ(comparison.exit_code, 0) << comparison.output << comparison.errors;
}

INSTANTIATE_TEST_SUITE_P(Shared, EveryRecording,
                         ::testing::Values(RecordingCase{"sheet_two_weights", "20:29", 3},
                                           RecordingCase{"sheet_two_weights_tags", "20:29", 3},
                                           RecordingCase{"robot_tip_weight", "25:29", 5}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// Played faster, the body moves further between frames; allocation and forces must stay.
struct FastCase {
  const char* name;
  int first_held;    // frame, from which on the load is at rest
  double max_error;  // %, as at full rate
  int every;
};

void PrintTo(const FastCase& recording, std::ostream* out) {
  *out << recording.name << " every " << recording.every;
}

class EveryRecordingFaster : public ::testing::TestWithParam<FastCase> {};

TEST_P(EveryRecordingFaster, KeepsAllocationAndForces) {
  const FastCase& recording = GetParam();
  const std::filesystem::path folder =
      std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings" / recording.name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recording at " << folder;
  const std::filesystem::path out =
      testing::FreshFolder(fmt::format("{}_{}", recording.name, recording.every));

  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}' --no-overlay --every {}", (folder / "scene.yaml").string(),
                  out.string(), recording.every));
  ASSERT_EQ(run.exit_code, 0) << run.errors;

  const auto truth = nlohmann::json::parse(testing::ReadText(folder / "truth.json"))["frames"];
  for (const auto& row : testing::ReadTable(out / "markers.csv")) {
    const int frame = std::atoi(row.at("frame").c_str());
    const int marker = std::atoi(row.at("marker").c_str());
    EXPECT_EQ(frame % recording.every, 0);
    EXPECT_EQ(row.at("status"), "seen") << "frame " << frame << " marker " << marker;
    const auto& place = truth[frame]["markers"]["pos"][marker];
    const char* const columns[] = {"x_mm", "y_mm", "z_mm"};
    for (int axis = 0; axis < 3; ++axis) {
      // mm; far more than noise, and far less than the markers' spacing.
      EXPECT_NEAR(std::atof(row.at(columns[axis]).c_str()), place[axis].get<double>(), 2);
    }
  }
  double norm = 0, true_norm = 0;  // N, summed over forces and frames at rest
  for (const auto& row : testing::ReadTable(out / "forces.csv")) {
    const int frame = std::atoi(row.at("frame").c_str());
    ASSERT_EQ(row.at("status"), "ok") << "frame " << frame;
    if (frame < recording.first_held) continue;
    const int force = std::atoi(row.at("force").c_str());
    const auto& F = truth[frame]["forces"][force]["F"];
    norm += std::atof(row.at("norm_N").c_str());
    true_norm += std::hypot(F[0].get<double>(), F[1].get<double>(), F[2].get<double>());
  }
  ASSERT_GT(true_norm, 0);
  EXPECT_LE(100 * std::abs(norm / true_norm - 1), recording.max_error);
}

INSTANTIATE_TEST_SUITE_P(Shared, EveryRecordingFaster,
                         ::testing::Values(FastCase{"sheet_two_weights", 20, 3, 2},
                                           FastCase{"sheet_two_weights", 20, 3, 3},
                                           FastCase{"robot_tip_weight", 25, 5, 2},
                                           FastCase{"robot_tip_weight", 25, 5, 3}),
                         [](const auto& instance) {
                           return fmt::format("{}_every_{}", instance.param.name,
                                              instance.param.every);
                         });

// With the mesh's own error corrected, the forces are to be within 1 %, which neither the robot
// (2.0 %, corrected 0.3 %) nor the sheet is without. The mesh behind the recordings is itself about
// as fine as the given one once refined.
class EveryRecordingCorrected : public ::testing::TestWithParam<RecordingCase> {};

TEST_P(EveryRecordingCorrected, GivesForcesWithinItsBound) {
  const RecordingCase& recording = GetParam();
  const std::filesystem::path folder =
      std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings" / recording.name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recording at " << folder;
  const std::filesystem::path out =
      testing::FreshFolder(std::string("corrected_") + recording.name);

  const testing::ProgramResult run =
      testing::RunProgram(fmt::format("run '{}' --out '{}' --no-overlay --correct-mesh refined",
                                      (folder / "scene.yaml").string(), out.string()));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const testing::ProgramResult comparison = testing::RunCommand(fmt::format(
      "'{}/scripts/compare_with_truth' '{}' '{}' --hold {} --max-error {}", SOFTFORCE_SOURCE_DIR,
      out.string(), (folder / "truth.json").string(), recording.hold, recording.max_error));

  EXPECT_EQ(comparison.exit_code, 0) << comparison.output << comparison.errors;
  EXPECT_NE(testing::ReadText(out / "summary.json").find("\"mesh_correction\""), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Shared, EveryRecordingCorrected,
                         ::testing::Values(RecordingCase{"sheet_two_weights", "20:29", 1},
                                           RecordingCase{"sheet_two_weights_tags", "20:29", 1},
                                           RecordingCase{"robot_tip_weight", "25:29", 1}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Demo, WritesEveryFileAndOnlyComplete) {
  const std::filesystem::path out = testing::FreshFolder("demo");
  const std::string scene =
      std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/scene.yaml";

  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}' --frames 0:4 --vtu", scene, out.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const char* name : {"forces.csv", "markers.csv", "summary.json", "overlay.mp4",
                           "results.pvd", "vtu/frame_00003.vtu"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
  }
  EXPECT_EQ(testing::ReadTable(out / "forces.csv").size(), 4u * 2);
  EXPECT_EQ(testing::ReadTable(out / "markers.csv").size(), 4u * 14);
}

TEST(Demo, GivesTheSameBytesOnAnyNumberOfThreads) {
  const std::string scene =
      std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/scene.yaml";
  std::string first;
  for (const int threads : {1, 2, 5}) {
    const std::filesystem::path out = testing::FreshFolder("threads");
    const testing::ProgramResult run = testing::RunProgram(fmt::format(
        "run '{}' --out '{}' --frames 0:4 --threads {} --vtu", scene, out.string(), threads));
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    std::string bytes;
    for (const char* name : {"forces.csv", "markers.csv", "vtu/frame_00003.vtu", "results.pvd"}) {
      bytes += testing::ReadText(out / name);
    }
    if (threads == 1) first = bytes;
    EXPECT_EQ(bytes, first) << threads << " threads";
  }
}

TEST(Program, ExplainsItself) {
  EXPECT_EQ(testing::RunProgram("--help").exit_code, 0);
  const testing::ProgramResult help = testing::RunProgram("run --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.output.find("--frames"), std::string::npos);
  EXPECT_EQ(testing::RunProgram("--version").exit_code, 0);
  EXPECT_EQ(testing::RunProgram("").exit_code, 2);
  EXPECT_EQ(testing::RunProgram("run").exit_code, 2);
  EXPECT_EQ(testing::RunProgram("run scene.yaml --no-such-option").exit_code, 2);
  for (const char* aim : {"perfectly", "1"}) {
    const testing::ProgramResult refused =
        testing::RunProgram(std::string("run scene.yaml --correct-mesh ") + aim);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.errors.find("expected none, refined or converged"), std::string::npos)
        << refused.errors;
  }
}

}  // namespace
}  // namespace softforce
