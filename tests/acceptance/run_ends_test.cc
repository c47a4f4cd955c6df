#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acceptance/program.h"

namespace softforce {
namespace {

const std::string kScene =
    std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/scene.yaml";

// The first stage that fails is that of the overlay, whose file cannot be opened.
TEST(RunThatFails, LeavesNothingOnAnyNumberOfThreads) {
  for (const int threads : {1, 3}) {
    const std::filesystem::path out = testing::FreshFolder("run_fails");
    std::filesystem::create_directory(out / "overlay.partial.mp4");

    const testing::ProgramResult run = testing::RunProgram(
        fmt::format("run '{}' --out '{}' --frames :6 --threads {}", kScene, out.string(), threads));

    EXPECT_EQ(run.exit_code, 2) << run.output << run.errors;
    EXPECT_NE(run.errors.find("overlay"), std::string::npos) << run.errors;
    EXPECT_TRUE(std::filesystem::is_empty(out)) << threads << " threads";
  }
}

TEST(RunThatIsStopped, HasCompleteFilesOfTheFramesSoFar) {
  const std::filesystem::path out = testing::FreshFolder("run_stopped");
  // Ctrl-C as soon as there are rows.
  const testing::ProgramResult run = testing::RunCommand(fmt::format(
      "sh -c '\"{0}\" run \"{1}\" --out \"{2}\" --no-overlay & "
      "while kill -0 $! && ! grep -q ok \"{2}/forces.partial.csv\"; do sleep 0.02; done; "
      "kill -INT $!; wait $!'",
      SOFTFORCE_PROGRAM, kScene, out.string()));

  EXPECT_EQ(run.exit_code, 1) << run.output << run.errors;
  EXPECT_NE(run.output.find("stopped before the end"), std::string::npos) << run.output;
  const auto rows = testing::ReadTable(out / "forces.csv");
  EXPECT_GE(rows.size(), 2u);
  EXPECT_LT(rows.size(), 60u);  // two forces in each of 30 frames
  EXPECT_EQ(rows.size() % 2, 0u);
  EXPECT_EQ(testing::ReadTable(out / "markers.csv").size(), rows.size() / 2 * 14);
  EXPECT_FALSE(std::filesystem::exists(out / "forces.partial.csv"));
}

}  // namespace
}  // namespace softforce
