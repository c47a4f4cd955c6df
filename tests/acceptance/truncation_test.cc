#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "acceptance/program.h"

namespace softforce {
namespace {

// A copy that lost its end, as when a disk was full or a recorder was killed: the index, which MP4
// writes last, is gone as well.
TEST(TruncatedVideo, GivesTheFramesBeforeTheCutAndExitCode1) {
  const std::filesystem::path folder = testing::CopyOfDemo("truncated");
  const std::filesystem::path video = folder / "left.mp4";
  std::filesystem::resize_file(video, std::filesystem::file_size(video) * 6 / 10);

  const testing::ProgramResult run =
      testing::RunProgram(fmt::format("run '{}' --out '{}' --no-overlay",
                                      (folder / "scene.yaml").string(), (folder / "out").string()));

  EXPECT_EQ(run.exit_code, 1) << run.errors;
  EXPECT_NE(run.output.find("left.mp4"), std::string::npos) << run.output;
  EXPECT_NE(testing::ReadText(folder / "out/summary.json").find("\"usable\": false"),
            std::string::npos);
  const auto rows = testing::ReadTable(folder / "out/forces.csv");
  ASSERT_GE(rows.size(), 2u * 5);  // two forces a frame
  EXPECT_LT(rows.size(), 2u * 30);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("status"), "ok");
    // The ramp: 0.559 N over 19 frames. A picture that was not whole would show as a force far off
    // it.
    const double truth = 0.559 * std::min(1.0, std::atoi(row.at("frame").c_str()) / 19.0);
    EXPECT_NEAR(std::atof(row.at("norm_N").c_str()), truth, 0.04) << "frame " << row.at("frame");
  }
}

}  // namespace
}  // namespace softforce
