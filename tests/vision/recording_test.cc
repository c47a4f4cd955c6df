#include "softforce/vision/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "vision/video_files.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;
using softforce::testing::AllPictures;
using softforce::testing::BarLevel;
using softforce::testing::GroundLevel;
using softforce::testing::Refusal;
using softforce::testing::RigOf;
using softforce::testing::TempFolder;
using softforce::testing::VideoKind;
using softforce::testing::WriteVideo;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kFramesPerSecond = 25;
const cv::Size kSize(320, 240);

class RecordingOf : public ::testing::TestWithParam<const char*> {
 protected:
  RecordingOf() {
    VideoKind kind;
    kind.extension = GetParam();
    const fs::path folder = TempFolder();
    sources_ = {{"left", WriteVideo(folder / "a", kind)},
                {"right", WriteVideo(folder / "b", kind)}};
  }
  std::vector<Recording::Source> sources_;
};

TEST_P(RecordingOf, DeliversEveryFrameOfEveryCamera) {
  Recording recording(RigOf(kSize), sources_);

  EXPECT_EQ(recording.announced_frames(), 30);
  for (int k = 0; k < 30; ++k) {
    const auto frame = recording.Next();
    ASSERT_TRUE(frame.has_value()) << k;
    EXPECT_EQ(frame->frame, k);
    EXPECT_NEAR(frame->time_s, k / kFramesPerSecond, 0.6e-3) << k;  // s; Matroska rounds to 1 ms
    ASSERT_EQ(frame->pictures.size(), 2u);
    for (const cv::Mat& picture : frame->pictures) {
      ASSERT_EQ(picture.type(), CV_8UC1);
      ASSERT_EQ(picture.size(), kSize);
      // Grey levels, through compression; of the ground and of the middle of the bar.
      EXPECT_NEAR(picture.at<uchar>(200, 160), GroundLevel(k), 2) << k;
      EXPECT_NEAR(picture.at<uchar>(64, 48 + 4 * k), BarLevel(k), 2) << k;
    }
  }
  EXPECT_FALSE(recording.Next().has_value());
  EXPECT_FALSE(recording.Next().has_value());
  EXPECT_EQ(recording.truncation(), "");
}

TEST_P(RecordingOf, GivesIdenticalPicturesAfterRewind) {
  Recording recording(RigOf(kSize), sources_);
  const auto first = AllPictures(&recording, 1);

  recording.Rewind();
  const auto second = AllPictures(&recording, 1);
  recording.Rewind();
  const auto frame = recording.Next();

  ASSERT_EQ(first.size(), 30u);
  ASSERT_EQ(second.size(), 30u);
  for (size_t k = 0; k < 30; ++k) EXPECT_EQ(cv::norm(first[k], second[k], cv::NORM_INF), 0) << k;
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->frame, 0);
  EXPECT_EQ(frame->time_s, 0);
}

std::string NameOfExtension(const ::testing::TestParamInfo<const char*>& info) {
  return std::string(info.param).substr(1);
}
INSTANTIATE_TEST_SUITE_P(Containers, RecordingOf, ::testing::Values(".mp4", ".mkv"),
                         NameOfExtension);

class RecordingRefusal : public ::testing::Test {
 protected:
  const fs::path folder_ = TempFolder();
  const fs::path good_ = WriteVideo(folder_ / "good", {".mp4"});
};

TEST_F(RecordingRefusal, NamesAMissingFile) {
  const std::string error =
      Refusal(RigOf(kSize), {{"left", good_}, {"right", folder_ / "none.mp4"}});
  EXPECT_THAT(error, AllOf(HasSubstr("none.mp4"), HasSubstr("no such video file")));
}

TEST_F(RecordingRefusal, NamesAFileThatIsNoVideo) {
  const fs::path text = folder_ / "notes.mp4";
  std::ofstream(text) << "these are not the pictures that you look for\n";
  const std::string error = Refusal(RigOf(kSize), {{"left", good_}, {"right", text}});
  EXPECT_THAT(error, AllOf(HasSubstr("notes.mp4"), HasSubstr("no video")));
}

TEST_F(RecordingRefusal, TakesNoEmptyFileAndNoFolder) {
  const fs::path empty = folder_ / "empty.mp4";
  std::ofstream{empty};
  EXPECT_THAT(Refusal(RigOf(kSize), {{"left", good_}, {"right", empty}}), HasSubstr("empty.mp4"));
  EXPECT_THAT(Refusal(RigOf(kSize), {{"left", good_}, {"right", folder_}}),
              HasSubstr("is a folder without times.csv"));
}

TEST_F(RecordingRefusal, NamesBothResolutions) {
  const std::string error = Refusal(RigOf({640, 480}), {{"left", good_}, {"right", good_}});
  EXPECT_THAT(error, AllOf(HasSubstr("good.mp4"), HasSubstr("320x240"), HasSubstr("640x480"),
                           HasSubstr("\"left\"")));
}

TEST_F(RecordingRefusal, NamesBothNumbersOfFrames) {
  VideoKind kind{".mp4"};
  kind.frames = 22;
  const fs::path shorter = WriteVideo(folder_ / "shorter", kind);
  const std::string error = Refusal(RigOf(kSize), {{"left", good_}, {"right", shorter}});
  EXPECT_THAT(error, AllOf(HasSubstr("shorter.mp4"), HasSubstr("good.mp4"), HasSubstr("22"),
                           HasSubstr("30")));
}

TEST_F(RecordingRefusal, NamesACameraThatTheRigHasNot) {
  const std::string error =
      Refusal(RigOf(kSize), {{"left", good_}, {"right", good_}, {"middle", good_}});
  EXPECT_THAT(error, AllOf(HasSubstr("\"middle\""), HasSubstr("\"left\""), HasSubstr("\"right\"")));
}

TEST_F(RecordingRefusal, NamesACameraWithoutASource) {
  EXPECT_THAT(Refusal(RigOf(kSize), {{"left", good_}}),
              AllOf(HasSubstr("\"right\""), HasSubstr("no source")));
}

}  // namespace
}  // namespace softforce::vision
