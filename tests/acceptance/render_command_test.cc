#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "acceptance/program.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;
using ::testing::HasSubstr;

// The shipped recording and a run on six of its frames, in one folder.
Folder RunOnDemo(const std::string& name, const std::string& options = "") {
  const Folder folder = testing::CopyOfDemo(name);
  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{0}/scene.yaml' --out '{0}/results' --frames 12:18 --overlay-width 960 "
                  "--no-report {1}",
                  folder.string(), options));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  return folder;
}

testing::ProgramResult Render(const Folder& results, const std::string& options) {
  return testing::RunProgram(
      fmt::format("render '{}' --overlay-width 960 {}", results.string(), options));
}

std::vector<cv::Mat> FramesOf(const Folder& video) {
  cv::VideoCapture capture(video.string());
  std::vector<cv::Mat> frames;
  for (cv::Mat frame; capture.read(frame);) frames.push_back(frame.clone());
  return frames;
}

// Grey levels, mean over all pixels and channels.
double Difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * a.channels());
}

TEST(RenderCommand, DrawsThePicturesOfTheRunAgain) {
  const Folder folder = RunOnDemo("render_again");

  const testing::ProgramResult rendered =
      Render(folder / "results", fmt::format("-o '{}/again.mp4'", folder.string()));

  ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
  EXPECT_THAT(rendered.output, ::testing::Not(HasSubstr("warning")));
  const std::vector<cv::Mat> before = FramesOf(folder / "results/overlay.mp4");
  const std::vector<cv::Mat> again = FramesOf(folder / "again.mp4");
  ASSERT_EQ(before.size(), 6u);
  ASSERT_EQ(again.size(), 6u);
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(cv::norm(before[i], again[i], cv::NORM_INF), 0) << i;
  }
}

TEST(RenderCommand, DrawsOnlyWhatIsAskedFor) {
  const Folder folder = RunOnDemo("render_none", "--no-overlay");

  const testing::ProgramResult rendered = Render(folder / "results", "--draw none");

  ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
  const std::vector<cv::Mat> bare = FramesOf(folder / "results/overlay.mp4");
  ASSERT_EQ(bare.size(), 6u);
  // Nothing is drawn, so nothing has a colour: only compression's, and the writing at the top.
  std::vector<cv::Mat> channels;
  cv::split(bare[0], channels);
  EXPECT_LT(Difference(channels[0], channels[2]), 0.5);  // grey levels
}

TEST(RenderCommand, FindsItsInputsWhenAllWasMovedTogether) {
  const Folder folder = RunOnDemo("render_moved", "--no-overlay");
  const Folder moved = testing::FreshFolder("render_moved_here");
  std::filesystem::remove(moved);
  std::filesystem::rename(folder, moved);

  const testing::ProgramResult rendered = Render(moved / "results", "");

  EXPECT_EQ(rendered.exit_code, 0) << rendered.errors;
  EXPECT_EQ(FramesOf(moved / "results/overlay.mp4").size(), 6u);
}

TEST(RenderCommand, SaysWhichVideoIsGoneAndTakesAnotherPlace) {
  const Folder folder = RunOnDemo("render_gone", "--no-overlay");
  std::filesystem::rename(folder / "right.mp4", folder / "elsewhere.mp4");

  const testing::ProgramResult gone = Render(folder / "results", "");
  const testing::ProgramResult found =
      Render(folder / "results", fmt::format("--camera 'right={}/elsewhere.mp4'", folder.string()));

  EXPECT_EQ(gone.exit_code, 2);
  EXPECT_THAT(gone.errors, HasSubstr("video of camera \"right\" of the run is gone"));
  EXPECT_THAT(gone.errors, HasSubstr("--camera right=FILE"));
  EXPECT_EQ(found.exit_code, 0) << found.errors;
  EXPECT_THAT(found.output, HasSubstr("elsewhere.mp4 is not what the run read"));
}

TEST(RenderCommand, RefusesAFolderWithoutResults) {
  const testing::ProgramResult rendered = Render(testing::FreshFolder("render_empty"), "");
  EXPECT_EQ(rendered.exit_code, 2);
  EXPECT_THAT(rendered.errors, HasSubstr("summary.json"));
}

TEST(RenderCommand, RefusesARunWithoutFrames) {
  const Folder folder = RunOnDemo("render_no_frames", "--no-overlay --no-frames");
  const testing::ProgramResult rendered = Render(folder / "results", "");
  EXPECT_EQ(rendered.exit_code, 2);
  EXPECT_THAT(rendered.errors, HasSubstr("frames.bin"));
}

TEST(RenderCommand, NeverReplacesAVideoOfTheRun) {
  const Folder folder = RunOnDemo("render_replace", "--no-overlay");
  const testing::ProgramResult rendered =
      Render(folder / "results", fmt::format("-o '{}/left.mp4'", folder.string()));
  EXPECT_EQ(rendered.exit_code, 2);
  EXPECT_THAT(rendered.errors, HasSubstr("would replace the input"));
}

}  // namespace
}  // namespace softforce
