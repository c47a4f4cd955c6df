#include "softforce/vision/board_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "softforce/base/input_error.h"
#include "softforce/vision/video_writer.h"

namespace softforce::vision {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

template <typename Action>
std::string Refusal(Action action) {
  try {
    action();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

class Inputs : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / "softforce_inputs" /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  // A picture whose grey tells it apart.
  std::string Picture(const std::string& name, int grey = 100, cv::Size size = {8, 6}) {
    const fs::path file = folder_ / name;
    fs::create_directories(file.parent_path());
    cv::imwrite(file.string(), cv::Mat1b(size, static_cast<uchar>(grey)));
    return file.string();
  }
  std::string Video(const std::string& name, int frames) {
    const fs::path file = folder_ / name;
    VideoWriter writer(file, 30);
    for (int k = 0; k < frames; ++k) {
      writer.Add(cv::Mat(64, 64, CV_8UC1, cv::Scalar(40 + 15 * k)));
    }
    writer.Commit();
    return file.string();
  }
  std::string At(const std::string& name) const { return (folder_ / name).string(); }
  std::string Sorted(const std::vector<std::string>& inputs) const {
    return Refusal([&] { SortInputs(inputs); });
  }

  fs::path folder_;
};

std::vector<std::string> Names(const std::vector<CameraInput>& cameras) {
  std::vector<std::string> names;
  for (const CameraInput& camera : cameras) names.push_back(camera.camera);
  return names;
}

std::vector<int> Numbers(const CameraInput& camera) {
  std::vector<int> numbers;
  for (const auto& picture : camera.pictures) numbers.push_back(picture.number);
  return numbers;
}

TEST_F(Inputs, ArePairedByTheNumberInTheirNames) {
  for (const char* name : {"left10.png", "left02.png", "right02.png", "right10.png"}) Picture(name);
  const auto cameras = SortInputs({At("left*.png"), At("right*.png")});
  EXPECT_THAT(Names(cameras), ElementsAre("left", "right"));
  EXPECT_THAT(Numbers(cameras[0]), ElementsAre(2, 10));
  EXPECT_THAT(Numbers(cameras[1]), ElementsAre(2, 10));
}

TEST_F(Inputs, ListedByTheShellGiveTheSameCameras) {
  std::vector<std::string> files;
  for (const char* name : {"rig_00_cam0.png", "rig_00_cam1.png", "rig_01_cam0.png",
                           "rig_01_cam1.png", "rig_02_cam0.png", "rig_02_cam1.png"}) {
    files.push_back(Picture(name));
  }
  const auto cameras = SortInputs(files);
  EXPECT_THAT(Names(cameras), ElementsAre("cam0", "cam1"));
  EXPECT_THAT(Numbers(cameras[1]), ElementsAre(0, 1, 2));
}

TEST_F(Inputs, InFoldersAreNamedByTheFolder) {
  for (const char* name : {"port/0001.png", "port/0002.png", "star/0001.png", "star/0002.png"}) {
    Picture(name);
  }
  const auto cameras = SortInputs({At("port"), At("star")});
  EXPECT_THAT(Names(cameras), ElementsAre("port", "star"));
  EXPECT_THAT(Numbers(cameras[0]), ElementsAre(1, 2));
}

TEST_F(Inputs, TakeTheNamesThatTheUserGives) {
  for (const char* name : {"a1.png", "a2.png", "b1.png", "b2.png"}) Picture(name);
  const auto cameras = SortInputs({"right=" + At("a?.png"), "left=" + At("b?.png")});
  EXPECT_THAT(Names(cameras), ElementsAre("right", "left"));
  EXPECT_EQ(cameras[0].pictures[0].file.filename(), "a1.png");
}

TEST_F(Inputs, OfOneCameraNeedNoNumbers) {
  for (const char* name : {"first.png", "other.png", "third.jpg"}) Picture(name);
  const auto cameras = SortInputs({folder_.string()});
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].camera, "camera");
  EXPECT_THAT(Numbers(cameras[0]), ElementsAre(0, 1, 2));
}

TEST_F(Inputs, OfOneCameraKeepTheirOwnNumbers) {
  for (const char* name : {"left07.png", "left09.png"}) Picture(name);
  const auto cameras = SortInputs({At("left*.png")});
  EXPECT_THAT(Names(cameras), ElementsAre("left"));
  EXPECT_THAT(Numbers(cameras[0]), ElementsAre(7, 9));
}

TEST_F(Inputs, AreRefusedWithTheFixWhereTheyDoNotFit) {
  const std::string left1 = Picture("left01.png");
  const std::string right2 = Picture("right02.png");
  EXPECT_THAT(Sorted({}), HasSubstr("there are none"));
  EXPECT_THAT(Sorted({left1, right2}),
              AllOf(HasSubstr("left01.png"), HasSubstr("\"right\" has no picture 1")));
  EXPECT_THAT(Sorted({At("middle*.png")}), HasSubstr("matches no picture"));
  EXPECT_THAT(Sorted({At("left03.png")}), HasSubstr("there is no such file"));
  EXPECT_THAT(Sorted({left1, left1}), HasSubstr("given twice"));
  std::ofstream(folder_ / "notes.txt") << "x";
  EXPECT_THAT(Sorted({At("notes.txt")}), HasSubstr("neither a picture nor a video"));
  fs::create_directories(folder_ / "empty");
  EXPECT_THAT(Sorted({At("empty")}), HasSubstr("without pictures"));
  const std::string same = Picture("again/left1.png");
  EXPECT_THAT(Sorted({"left=" + left1, "left=" + same, "right=" + right2}),
              HasSubstr("has a picture 1 already"));
  EXPECT_THAT(Sorted({"left=" + Picture("some.png"), "right=" + right2}),
              HasSubstr("has no number"));
  std::ofstream(folder_ / "film.mp4") << "x";
  EXPECT_THAT(Sorted({left1, At("film.mp4")}), HasSubstr("mixed"));
  std::ofstream(folder_ / "film2.mp4") << "x";
  EXPECT_THAT(Sorted({"left=" + At("film.mp4"), "left=" + At("film2.mp4")}),
              HasSubstr("has a video already"));
}

TEST_F(Inputs, AreReadSetBySet) {
  for (const int k : {1, 2, 3}) {
    Picture("left" + std::to_string(k) + ".png", 10 * k);
    Picture("right" + std::to_string(k) + ".png", 10 * k + 5);
  }
  BoardPictures pictures(SortInputs({folder_.string()}));
  EXPECT_FALSE(pictures.is_video());
  EXPECT_EQ(pictures.announced_sets(), 3);
  EXPECT_EQ(pictures.Skip(1), 1);
  const auto set = pictures.Next();
  ASSERT_TRUE(set);
  EXPECT_EQ(set->number, 2);
  EXPECT_EQ(set->pictures[0].at<uchar>(0, 0), 20);
  EXPECT_EQ(set->pictures[1].at<uchar>(0, 0), 25);
  EXPECT_THAT(set->sources[1], HasSubstr("right2.png"));
  EXPECT_TRUE(pictures.Next());
  EXPECT_FALSE(pictures.Next());
  EXPECT_EQ(pictures.Skip(4), 0);
}

TEST_F(Inputs, OfMixedSizesInOneCameraAreRefused) {
  Picture("left1.png");
  const std::string other = Picture("left2.png", 100, {12, 6});
  BoardPictures pictures(SortInputs({folder_.string()}));
  pictures.Next();
  EXPECT_THAT(Refusal([&] { pictures.Next(); }),
              AllOf(HasSubstr(other), HasSubstr("is 12x6 px"), HasSubstr("left1.png"),
                    HasSubstr("8x6 px")));
}

TEST_F(Inputs, OfDifferentSizesInDifferentCamerasAreFine) {
  Picture("left1.png");
  Picture("right1.png", 100, {12, 6});
  BoardPictures pictures(SortInputs({folder_.string()}));
  EXPECT_TRUE(pictures.Next());
}

TEST_F(Inputs, ThatCannotBeReadAreNamed) {
  std::ofstream(folder_ / "left1.png") << "no picture";
  BoardPictures pictures(SortInputs({folder_.string()}));
  EXPECT_THAT(Refusal([&] { pictures.Next(); }),
              AllOf(HasSubstr("left1.png"), HasSubstr("cannot be read")));
}

TEST_F(Inputs, FromVideosComeFrameByFrame) {
  const auto cameras = SortInputs({Video("left.mp4", 4), Video("right.mp4", 4)});
  EXPECT_THAT(Names(cameras), ElementsAre("left", "right"));
  BoardPictures pictures(cameras);
  EXPECT_TRUE(pictures.is_video());
  EXPECT_EQ(pictures.announced_sets(), 4);
  EXPECT_EQ(pictures.Skip(2), 2);
  const auto set = pictures.Next();
  ASSERT_TRUE(set);
  EXPECT_EQ(set->number, 2);
  EXPECT_NEAR(set->pictures[0].at<uchar>(32, 32), 70, 4);  // grey levels, coded with loss
  EXPECT_THAT(set->sources[0], HasSubstr("left.mp4 frame 2"));
}

TEST_F(Inputs, FromVideosOfDifferentLengthsAreRefused) {
  const auto cameras = SortInputs({Video("left.mp4", 4), Video("right.mp4", 6)});
  EXPECT_THAT(Refusal([&] { BoardPictures pictures(cameras); }),
              AllOf(HasSubstr("right.mp4"), HasSubstr("has 6 frames"), HasSubstr("has 4")));
}

}  // namespace
}  // namespace softforce::vision
