#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>

#include "softforce/vision/recording.h"
#include "vision/video_files.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;
using softforce::testing::AllPictures;
using softforce::testing::CutFile;
using softforce::testing::Refusal;
using softforce::testing::RigOf;
using softforce::testing::TempFolder;
using softforce::testing::VideoKind;
using softforce::testing::WriteVideo;
using ::testing::AllOf;
using ::testing::HasSubstr;

const cv::Size kSize(320, 240);

std::vector<cv::Mat> PicturesOf(const fs::path& left, const fs::path& right, cv::Size size,
                                std::string* truncation = nullptr) {
  Recording recording(RigOf(size), {{"left", left}, {"right", right}});
  std::vector<cv::Mat> pictures = AllPictures(&recording, 0);
  if (truncation != nullptr) *truncation = recording.truncation();
  return pictures;
}

// Each delivered picture must be the whole file's picture of the same frame: neither half decoded,
// nor a later one.
void ExpectBeginningOf(const std::vector<cv::Mat>& whole, const std::vector<cv::Mat>& delivered,
                       const std::string& where) {
  ASSERT_LE(delivered.size(), whole.size()) << where;
  for (size_t k = 0; k < delivered.size(); ++k) {
    EXPECT_EQ(cv::norm(whole[k], delivered[k], cv::NORM_INF), 0) << where << ", frame " << k;
  }
}

class Truncation : public ::testing::Test {
 protected:
  // Cuts a file after each of many shares of its length; its sibling is whole.
  void CutEverywhere(const fs::path& file) {
    const std::vector<cv::Mat> whole = PicturesOf(file, file, kSize);
    ASSERT_EQ(whole.size(), 30u);
    const fs::path cut = folder_ / ("cut" + file.extension().string());
    size_t most = 0;
    for (double share = 0.2; share < 0.95; share += 0.03) {
      CutFile(file, share, cut);
      std::string truncation;
      const auto delivered = PicturesOf(cut, file, kSize, &truncation);
      ExpectBeginningOf(whole, delivered, "cut at " + std::to_string(share));
      EXPECT_LT(delivered.size(), whole.size()) << share;
      EXPECT_THAT(truncation, AllOf(HasSubstr("cut" + file.extension().string()),
                                    HasSubstr(std::to_string(delivered.size()) + " of 30")));
      most = std::max(most, delivered.size());
    }
    EXPECT_GT(most, 15u);  // frames; the last cut leaves nearly all
  }
  const fs::path folder_ = TempFolder();
};

TEST_F(Truncation, OfAnMp4DeliversTheFramesBeforeTheCut) {
  CutEverywhere(WriteVideo(folder_ / "whole", {".mp4"}));
}

TEST_F(Truncation, OfAMatroskaFileDeliversTheFramesBeforeTheCut) {
  CutEverywhere(WriteVideo(folder_ / "whole", {".mkv"}));
}

TEST_F(Truncation, OfAnMp4WithinItsIndexLosesNoPicture) {
  const fs::path file = WriteVideo(folder_ / "whole", {".mp4"});
  const auto size = static_cast<double>(fs::file_size(file));
  const fs::path cut = CutFile(file, (size - 8) / size, folder_ / "cut.mp4");

  std::string truncation;
  const auto delivered = PicturesOf(cut, file, kSize, &truncation);

  EXPECT_EQ(delivered.size(), 30u);
  ExpectBeginningOf(PicturesOf(file, file, kSize), delivered, "cut in the index");
  EXPECT_EQ(truncation, "");
}

TEST_F(Truncation, IsNamedAfterRewindToo) {
  const fs::path file = WriteVideo(folder_ / "whole", {".mp4"});
  const fs::path cut = CutFile(file, 0.5, folder_ / "cut.mp4");
  Recording recording(RigOf(kSize), {{"left", cut}, {"right", file}});
  const auto first = AllPictures(&recording, 0);
  const std::string truncation = recording.truncation();

  recording.Rewind();
  EXPECT_EQ(recording.truncation(), "");
  const auto second = AllPictures(&recording, 0);

  EXPECT_EQ(first.size(), second.size());
  EXPECT_EQ(recording.truncation(), truncation);
}

TEST_F(Truncation, OfBothMatroskaFilesEndsWithTheShorter) {
  const fs::path file = WriteVideo(folder_ / "whole", {".mkv"});
  const fs::path shorter = CutFile(file, 0.4, folder_ / "a.mkv");
  const fs::path longer = CutFile(file, 0.8, folder_ / "b.mkv");
  std::string truncation;
  const auto both = PicturesOf(longer, shorter, kSize, &truncation);
  EXPECT_EQ(both.size(), PicturesOf(shorter, file, kSize).size());
  EXPECT_LT(both.size(), PicturesOf(longer, file, kSize).size());
  EXPECT_THAT(truncation, HasSubstr("a.mkv"));
}

TEST_F(Truncation, OfBothMp4FilesIsRefusedForTheMissingIndex) {
  const fs::path file = WriteVideo(folder_ / "whole", {".mp4"});
  const fs::path left = CutFile(file, 0.4, folder_ / "a.mp4");
  const fs::path right = CutFile(file, 0.8, folder_ / "b.mp4");
  EXPECT_THAT(Refusal(RigOf(kSize), {{"left", left}, {"right", right}}),
              AllOf(HasSubstr("a.mp4"), HasSubstr("index (moov)"), HasSubstr("cut off")));
}

TEST_F(Truncation, OfAnMp4NeedsASiblingOfItsOwnKind) {
  const fs::path file = WriteVideo(folder_ / "whole", {".mp4"});
  const fs::path cut = CutFile(file, 0.5, folder_ / "cut.mp4");
  const fs::path other = WriteVideo(folder_ / "other", {".mkv"});
  EXPECT_THAT(Refusal(RigOf(kSize), {{"left", cut}, {"right", other}}),
              AllOf(HasSubstr("cut.mp4"), HasSubstr("index (moov)")));
}

TEST_F(Truncation, LeavesNoTemporaryFiles) {
  const auto count = [] {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(fs::temp_directory_path())) {
      files += entry.path().extension() == ".h264" &&
               entry.path().filename().string().rfind("softforce-", 0) == 0;
    }
    return files;
  };
  const fs::path file = WriteVideo(folder_ / "whole", {".mp4"});
  const fs::path cut = CutFile(file, 0.5, folder_ / "cut.mp4");
  const int before = count();
  PicturesOf(cut, file, kSize);
  EXPECT_EQ(count(), before);
}

TEST_F(Truncation, OfAShippedRecordingDeliversExactlyItsFrames) {
  const fs::path shipped =
      fs::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings/sheet_two_weights";
  if (!fs::exists(shipped / "left.mp4")) GTEST_SKIP() << "no recordings beside the project";
  const cv::Size size(1280, 1024);
  const auto whole = PicturesOf(shipped / "left.mp4", shipped / "right.mp4", size);
  ASSERT_EQ(whole.size(), 30u);
  for (const double share : {0.3, 0.45, 0.6, 0.75, 0.9}) {
    const fs::path cut = CutFile(shipped / "left.mp4", share, folder_ / "cut.mp4");
    std::string truncation;
    const auto delivered = PicturesOf(cut, shipped / "right.mp4", size, &truncation);
    std::cout << "cut at " << 100 * share << " %: " << delivered.size() << " of 30 frames\n";
    ExpectBeginningOf(whole, delivered, "cut at " + std::to_string(share));
    EXPECT_GT(delivered.size(), 30 * share - 8);  // frames; the key frame is large, B-frames lag
    EXPECT_THAT(truncation, HasSubstr("cut.mp4"));
  }
}

}  // namespace
}  // namespace softforce::vision
