#include "softforce/vision/video_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <random>
#include <vector>

#include "softforce/base/input_error.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/recording.h"
#include "softforce/vision/tags.h"
#include "vision/synthetic_picture.h"
#include "vision/tag_pictures.h"
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

// Discs and tags in noise, moved a little from frame to frame.
cv::Mat PictureToMeasureIn(int frame) {
  std::mt19937 random(static_cast<unsigned>(frame));
  softforce::testing::SyntheticScene scene(480, 360, 70);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d at(60 + 100 * (i % 4) + 0.37 * i + 0.61 * frame,
                             50 + 80 * (i / 4) + 0.21 * i);
    PaintEllipse({at, 15 + 0.3 * i, 12, 0.3 * i}, 200, &scene);
  }
  for (int i = 0; i < 4; ++i) {
    PaintTag(
        DrawTag("tag36h11", i),
        softforce::testing::SquareAt({70.3 + 105 * i - 0.3 * frame, 305.2 + 3 * i}, 44, 0.2 * i),
        &scene);
  }
  return scene.TakePicture(1.7, random);
}

TEST(VideoWriter, KeepsCentresAndCornersInAVideoToMeasureIn) {
  const fs::path file = TempFolder() / "left.mp4";
  constexpr int kFrames = 5;
  std::vector<cv::Mat> pictures;
  VideoWriter writer(file, 30, VideoQuality::kMeasuring);
  for (int k = 0; k < kFrames; ++k) {
    pictures.push_back(PictureToMeasureIn(k));
    writer.Add(pictures.back());
  }
  writer.Commit();

  camera::Rig rig;
  rig.cameras.emplace_back();
  rig.cameras[0].name = "left";
  rig.cameras[0].width = 480;
  rig.cameras[0].height = 360;
  Recording recording(rig, {{"left", file}});
  const TagDetector tags("tag36h11");
  double dot_squares = 0, corner_squares = 0;
  int dots = 0, corners = 0;
  for (int k = 0; k < kFrames; ++k) {
    const cv::Mat before = pictures[k], after = recording.Next()->pictures[0];
    EXPECT_LT(std::abs(cv::mean(before)[0] - cv::mean(after)[0]), 0.3) << k;  // grey levels
    const auto dots_before = DetectDots(before), dots_after = DetectDots(after);
    const auto tags_before = tags.Detect(before), tags_after = tags.Detect(after);
    ASSERT_EQ(tags_before.size(), tags_after.size());
    for (const Dot& dot : dots_before) {
      if (dot.centroid.y() > 250) continue;  // parts of tags
      double nearest = 1e9;
      for (const Dot& other : dots_after) {
        nearest = std::min(nearest, (other.centroid - dot.centroid).squaredNorm());
      }
      dot_squares += nearest;
      ++dots;
    }
    for (size_t t = 0; t < tags_before.size(); ++t) {
      for (int i = 0; i < 4; ++i) {
        corner_squares += (tags_before[t].corners[i] - tags_after[t].corners[i]).squaredNorm();
        ++corners;
      }
    }
  }
  ASSERT_EQ(dots, 12 * kFrames);
  ASSERT_EQ(corners, 16 * kFrames);
  // px, of the 2-D distance: as VideoQuality promises.
  EXPECT_LT(std::sqrt(dot_squares / dots), 0.02);
  EXPECT_LT(std::sqrt(corner_squares / corners), 0.02);
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
