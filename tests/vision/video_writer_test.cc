#include "softforce/vision/video_writer.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "softforce/base/input_error.h"
#include "vision/video_files.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;
using softforce::testing::GroundLevel;
using softforce::testing::NumberedPicture;
using softforce::testing::TempFolder;

cv::Mat ColourPicture(int frame, cv::Size size) {
  cv::Mat bgr;
  cv::cvtColor(NumberedPicture(frame, size), bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

bool IsEmpty(const fs::path& folder) { return fs::is_empty(folder); }

TEST(VideoWriter, WritesAFileThatPlays) {
  const fs::path file = TempFolder() / "overlay.mp4";
  VideoWriter writer(file, 25);
  for (int k = 0; k < 20; ++k) writer.Add(ColourPicture(k, {321, 241}));  // odd sides are trimmed
  writer.Commit();

  cv::VideoCapture video(file.string(), cv::CAP_FFMPEG);
  ASSERT_TRUE(video.isOpened());
  EXPECT_EQ(video.get(cv::CAP_PROP_FRAME_COUNT), 20);
  EXPECT_NEAR(video.get(cv::CAP_PROP_FPS), 25, 0.01);
  EXPECT_EQ(video.get(cv::CAP_PROP_FRAME_WIDTH), 320);
  EXPECT_EQ(video.get(cv::CAP_PROP_FRAME_HEIGHT), 240);
  cv::Mat picture;
  for (int k = 0; k < 20; ++k) {
    ASSERT_TRUE(video.read(picture)) << k;
    EXPECT_NEAR(picture.at<cv::Vec3b>(200, 160)[1], GroundLevel(k), 4) << k;  // grey levels
  }
}

TEST(VideoWriter, ShowsTheFileOnlyOnceItIsComplete) {
  const fs::path file = TempFolder() / "overlay.mp4";
  VideoWriter writer(file, 25);
  for (int k = 0; k < 5; ++k) writer.Add(ColourPicture(k, {320, 240}));
  EXPECT_FALSE(fs::exists(file));
  writer.Commit();
  EXPECT_TRUE(fs::exists(file));
}

TEST(VideoWriter, LeavesNothingWithoutCommit) {
  const fs::path folder = TempFolder();
  {
    VideoWriter writer(folder / "overlay.mp4", 25);
    for (int k = 0; k < 5; ++k) writer.Add(ColourPicture(k, {320, 240}));
  }
  EXPECT_TRUE(IsEmpty(folder));
}

TEST(VideoWriter, WritesNoFileOfNoPictures) {
  const fs::path folder = TempFolder();
  VideoWriter writer(folder / "overlay.mp4", 25);
  writer.Commit();
  EXPECT_TRUE(IsEmpty(folder));
}

TEST(VideoWriter, RefusesAFolderThatDoesNotExist) {
  VideoWriter writer(TempFolder() / "none" / "overlay.mp4", 25);
  EXPECT_THROW(writer.Add(ColourPicture(0, {320, 240})), base::InputError);
}

}  // namespace
}  // namespace softforce::vision
