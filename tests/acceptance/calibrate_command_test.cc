#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgcodecs.hpp>

#include "acceptance/board_scene.h"
#include "acceptance/program.h"
#include "softforce/scene/rig_file.h"
#include "softforce/vision/video_writer.h"

namespace softforce {
namespace {

namespace fs = std::filesystem;
using testing::BoardPlace;
using testing::FreshFolder;
using testing::GoodPlaces;
using ::testing::HasSubstr;
using testing::MakeChessboard;
using ::testing::Not;
using testing::ProgramResult;
using testing::WritePictures;

const std::string kBoard = "chessboard:9x6,square=20mm";

// Calibrates with the pictures left??.png and right??.png of a folder.
ProgramResult CalibrateIn(const fs::path& folder, const std::string& board = kBoard,
                          const std::string& more = "") {
  return testing::RunProgram(
      fmt::format("calibrate '{0}/left??.png' '{0}/right??.png' --board {1} "
                  "-o {0}/rig.yaml --report {0}/report.html {2}",
                  folder.string(), board, more));
}

fs::path GoodPictures(const std::string& name, size_t count = 10) {
  const fs::path folder = FreshFolder(name);
  std::vector<BoardPlace> places = GoodPlaces();
  places.resize(count);
  WritePictures(MakeChessboard(9, 6), places, folder);
  return folder;
}

TEST(CalibrateCommand, FindsARenderedPair) {
  const fs::path folder = GoodPictures("calibrate_pair");
  const ProgramResult result =
      CalibrateIn(folder, kBoard,
                  fmt::format("--model brown4 --also opencv={0}/cv.yaml --also "
                              "kalibr={0}/kalibr.yaml --also ros={0}/ros",
                              folder.string()));

  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  EXPECT_THAT(result.output, HasSubstr("2 cameras, 10 views"));
  const camera::Rig rig = scene::LoadRig(folder / "rig.yaml");
  ASSERT_EQ(rig.cameras.size(), 2);
  EXPECT_EQ(rig.cameras[1].name, "right");
  // px; ten pictures of 0.02 px noise give some 0.1 px, half of that again for the painting
  EXPECT_NEAR(rig.cameras[0].lens.fx, testing::BoardScene::kFocal, 0.7);
  const Eigen::Vector3d t = rig.cameras[1].T_camera_rig.translation();
  EXPECT_LT((t - Eigen::Vector3d(-testing::BoardScene::kBaseline, 0, 0)).norm(), 1e-4);  // m
  const auto statistics = scene::LoadRigStatistics(folder / "rig.yaml");
  ASSERT_TRUE(statistics.has_value());
  EXPECT_EQ(statistics->board, kBoard);
  EXPECT_EQ(statistics->covariance.rows(), statistics->parameters.size());
  EXPECT_THAT(testing::ReadText(folder / "report.html"), HasSubstr("<svg"));
  // Every other tool's file holds the same rig.
  for (const std::vector<fs::path>& files :
       {std::vector<fs::path>{folder / "cv.yaml"},
        {folder / "kalibr.yaml"},
        {folder / "ros/left.yaml", folder / "ros/right.yaml"}}) {
    const camera::Rig other = scene::LoadRig(files, {});
    const Eigen::Matrix4d difference =
        other.cameras[1].T_camera_rig.matrix() - rig.cameras[1].T_camera_rig.matrix();
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << files[0];  // rounding
  }
}

TEST(CalibrateCommand, GivesTheSameBytesTwice) {
  const fs::path first = GoodPictures("calibrate_first", 5),
                 second = GoodPictures("calibrate_second", 5);
  CalibrateIn(first, kBoard, "--model brown4");
  CalibrateIn(second, kBoard, "--model brown4");

  EXPECT_EQ(testing::ReadText(first / "rig.yaml"), testing::ReadText(second / "rig.yaml"));
  EXPECT_EQ(testing::ReadText(first / "report.html"), testing::ReadText(second / "report.html"));
}

TEST(CalibrateCommand, TakesASingleCamera) {
  const fs::path folder = GoodPictures("calibrate_single");
  const ProgramResult result = testing::RunProgram(fmt::format(
      "calibrate --camera 'eye={0}/left*.png' --board {1} -o {0}/rig.yaml --model brown4",
      folder.string(), kBoard));

  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  const camera::Rig rig = scene::LoadRig(folder / "rig.yaml");
  ASSERT_EQ(rig.cameras.size(), 1);
  EXPECT_EQ(rig.cameras[0].name, "eye");
}

TEST(CalibrateCommand, TakesOneViewOfEachPlaceFromVideos) {
  const fs::path folder = FreshFolder("calibrate_video");
  const testing::BoardScene scene = MakeChessboard(9, 6);
  std::vector<BoardPlace> places = GoodPlaces();
  places.resize(6);
  for (const bool right : {false, true}) {
    vision::VideoWriter video(folder / (right ? "right.mp4" : "left.mp4"), 30,
                              vision::VideoQuality::kMeasuring);
    for (const BoardPlace& place : places) {
      const cv::Mat picture = scene.Picture(place.turn, place.middle, right);
      for (int k = 0; k < 3; ++k) video.Add(picture);
    }
    video.Commit();
  }
  const ProgramResult result = testing::RunProgram(
      fmt::format("calibrate {0}/left.mp4 {0}/right.mp4 --board {1} -o {0}/rig.yaml --model brown4",
                  folder.string(), kBoard));

  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  EXPECT_THAT(result.output, HasSubstr("2 cameras, 6 views"));
}

TEST(CalibrateCommand, NamesTheBoardThatIsThereInstead) {
  const fs::path folder = GoodPictures("calibrate_wrong_size");
  const ProgramResult result = CalibrateIn(folder, "chessboard:10x7,square=20mm");

  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("camera \"left\": chessboard:10x7,square=20mm was found in "
                                       "none of 10 pictures"));
  EXPECT_THAT(result.errors, HasSubstr("chessboard:9x6,square=20mm"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

TEST(CalibrateCommand, SaysThatNoBoardIsThere) {
  const fs::path folder = FreshFolder("calibrate_none");
  for (const char* const name : {"left00.png", "left01.png", "right00.png", "right01.png"}) {
    cv::imwrite((folder / name).string(), cv::Mat(480, 640, CV_8UC1, cv::Scalar(120)));
  }
  const ProgramResult result = CalibrateIn(folder);

  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("was found in none of 2 pictures (left00.png: "));
  EXPECT_THAT(result.errors, HasSubstr("Check that the whole board is in the picture"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

TEST(CalibrateCommand, NamesMarkersThatTheBoardHasNot) {
  testing::BoardScene scene;
  scene.pixels_per_metre = 80 / 0.02;
  const auto printed = cv::aruco::CharucoBoard::create(
      7, 10, 0.02f, 0.015f, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
  printed->draw({720, 960}, scene.print, 80);
  const fs::path folder = FreshFolder("calibrate_ids");
  WritePictures(scene, GoodPlaces(), folder);
  const ProgramResult result =
      CalibrateIn(folder, "charuco:5x7,square=20mm,marker=15mm,dictionary=4X4_50");

  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("left00.png: got markers with ids 0 to 34, the board of "
                                       "--board has 0 to 16"));
}

TEST(CalibrateCommand, RefusesPicturesOfSeveralSizes) {
  const fs::path folder = GoodPictures("calibrate_sizes");
  cv::imwrite((folder / "right03.png").string(), cv::Mat(512, 640, CV_8UC1, cv::Scalar(120)));
  const ProgramResult result = CalibrateIn(folder);

  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("right03.png: is 640x512 px, but "));
  EXPECT_THAT(result.errors, HasSubstr("right00.png of the same camera \"right\" is 640x480 px\n"
                                       "  A calibration is of one resolution"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

TEST(CalibrateCommand, IsNotUsableWithTooFewViews) {
  const fs::path folder = GoodPictures("calibrate_few", 2);
  const ProgramResult result = CalibrateIn(folder);

  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("Not usable (too few views): camera \"left\" has 2 usable "
                                       "pictures of the board"));
  EXPECT_THAT(result.output, HasSubstr("expected at least 3\n  Take more pictures"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
  EXPECT_THAT(testing::ReadText(folder / "report.html"), HasSubstr("not usable"));
}

TEST(CalibrateCommand, NamesCamerasThatNeverSeeTheBoardTogether) {
  const fs::path folder = GoodPictures("calibrate_apart");
  const cv::Mat blank(480, 640, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 10; ++i) {
    cv::imwrite((folder / fmt::format("{}0{}.png", i < 5 ? "right" : "left", i)).string(), blank);
  }
  const ProgramResult result = CalibrateIn(folder);

  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output,
              HasSubstr("Not usable (cameras not connected): no view shows the board "
                        "to cameras of different groups: {left} and {right}\n"
                        "  Hold the board where"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

// Pictures of a board that was held in eight places, at tilts (rad) from `tilt` to its negative.
fs::path StraightPictures(const std::string& name, double tilt) {
  const fs::path folder = FreshFolder(name);
  std::vector<BoardPlace> places;
  for (int i = 0; i < 8; ++i) {
    places.push_back({{tilt * (i % 3 - 1), tilt * (i / 3 % 3 - 1), 0.1 * i},
                      {0.02 * (i % 4), 0.03 * (i % 3) - 0.03, 0.42 + 0.04 * i}});
  }
  WritePictures(MakeChessboard(9, 6), places, folder);
  return folder;
}

// Focal length and distance may be anything then, as long as they go together: not usable.
TEST(CalibrateCommand, IsNotUsableIfTheBoardAlwaysFacedTheCamerasStraight) {
  const fs::path folder = StraightPictures("calibrate_flat", 0);
  const ProgramResult result = CalibrateIn(folder, kBoard, "--model brown4");

  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("Not usable (undetermined)"));
  EXPECT_THAT(result.output, HasSubstr("the board was never tilted by more than 0 degrees"));
  EXPECT_THAT(result.output, HasSubstr("Take views with the board tilted by 30 to 45 degrees"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

// Five degrees tell it in sharp pictures, but only just.
TEST(CalibrateCommand, WarnsOfABoardThatHardlyTilted) {
  const fs::path folder = StraightPictures("calibrate_slight", 0.09);
  const ProgramResult result = CalibrateIn(folder, kBoard, "--model brown4");

  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  EXPECT_THAT(result.output, HasSubstr("left: the board was never tilted by more than"));
  EXPECT_THAT(result.output, HasSubstr("Tilt it by 30 to 45 degrees"));
}

TEST(CalibrateCommand, RefusesWhatKalibrCannotHoldBeforeTheWork) {
  const fs::path folder = FreshFolder("calibrate_kalibr");
  WritePictures(MakeChessboard(9, 6), {GoodPlaces()[0]}, folder);
  const ProgramResult result =
      CalibrateIn(folder, kBoard, "--also kalibr=" + (folder / "chain.yaml").string());

  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("Add --model brown4"));
}

// What the shared pictures of three boards, of the same pair of cameras, must give: ten pairs of
// each, to save time.
struct Recorded {
  const char* name;
  const char* pattern;
  const char* board;
};

void PrintTo(const Recorded& recorded, std::ostream* out) { *out << recorded.name; }

class CalibrateRecorded : public ::testing::TestWithParam<Recorded> {};

TEST_P(CalibrateRecorded, FindsTheTrueCameras) {
  const fs::path shared = fs::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings/calibration";
  if (!fs::exists(shared)) GTEST_SKIP() << "no " << shared;
  const fs::path folder = FreshFolder(std::string("calibrate_") + GetParam().name);
  const ProgramResult result = testing::RunProgram(
      fmt::format("calibrate '{}/{}' --board {} -o {}/rig.yaml --model brown5", shared.string(),
                  GetParam().pattern, GetParam().board, folder.string()));
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;

  const camera::Rig rig = scene::LoadRig(folder / "rig.yaml");
  const auto truth = nlohmann::json::parse(testing::ReadText(shared / "cameras_truth.json"));
  for (const std::string side : {"left", "right"}) {
    const auto camera = rig.Find(side);
    ASSERT_TRUE(camera.has_value()) << side;
    const double fx = truth[side]["K"][0][0], fy = truth[side]["K"][1][1];
    EXPECT_NEAR(rig.cameras[*camera].lens.fx / fx, 1, 1e-3) << side;  // the goal of 0.1 %
    EXPECT_NEAR(rig.cameras[*camera].lens.fy / fy, 1, 1e-3) << side;
  }
  const auto t = truth["stereo"]["t_mm"].get<std::vector<double>>();
  const double baseline = Eigen::Vector3d(t.data()).norm();                            // mm
  EXPECT_NEAR(1e3 * rig.cameras[1].T_camera_rig.translation().norm(), baseline, 0.1);  // the goal
}

INSTANTIATE_TEST_SUITE_P(
    Shared, CalibrateRecorded,
    ::testing::Values(Recorded{"chessboard", "chess_0*.jpg", "chessboard:9x6,square=20mm"},
                      Recorded{"charuco", "charuco_0*.jpg",
                               "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50"},
                      Recorded{"aprilgrid", "aprilgrid_0*.jpg",
                               "aprilgrid:6x6,tag=24mm,spacing=0.3"}),
    [](const auto& recorded) { return recorded.param.name; });

TEST(CalibrateCommand, MeasuresHeldOutBoardsOfRealPictures) {
  const fs::path data = "/usr/share/doc/opencv-doc/examples/data";
  if (!fs::exists(data / "left01.jpg")) GTEST_SKIP() << "no pictures of opencv-doc in " << data;
  const fs::path folder = FreshFolder("calibrate_opencv_doc");
  const ProgramResult result = testing::RunProgram(
      fmt::format("calibrate '{0}/left??.jpg' '{0}/right??.jpg' --board chessboard:9x6,square=25mm "
                  "-o {1}/rig.yaml",
                  data.string(), folder.string()));
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;

  const auto statistics = scene::LoadRigStatistics(folder / "rig.yaml");
  ASSERT_TRUE(statistics.has_value());
  EXPECT_EQ(statistics->views, 13);
  EXPECT_LE(statistics->held_out_square, 0.17e-3);  // m, the goal; OpenCV's own gives 0.207 mm
  EXPECT_LE(statistics->held_out_board, 0.36e-3);   // m, the goal; OpenCV's own gives 0.428 mm
}

TEST(RigCommand, ConvertsARigThereAndBack) {
  const fs::path folder = FreshFolder("rig_convert");
  const fs::path rig = fs::path(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights/rig.yaml";
  const auto run = [&](const std::string& arguments) {
    const ProgramResult result = testing::RunProgram("rig " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  };
  run(fmt::format("{} -o {}/cv.yaml --format opencv", rig.string(), folder.string()));
  run(fmt::format("{0}/cv.yaml -o {0}/ros --format ros", folder.string()));
  run(fmt::format("{0}/ros/left.yaml {0}/ros/right.yaml -o {0}/rig.yaml", folder.string()));

  const camera::Rig original = scene::LoadRig(rig), back = scene::LoadRig(folder / "rig.yaml");
  ASSERT_EQ(back.cameras.size(), 2);
  EXPECT_EQ(back.cameras[1].name, original.cameras[1].name);
  EXPECT_EQ(back.cameras[1].lens.fx, original.cameras[1].lens.fx);
  const Eigen::Isometry3d wanted =
      original.cameras[1].T_camera_rig * original.cameras[0].T_camera_rig.inverse();
  // The file's own rotation is rounded at 1e-10; the other formats make it a true one.
  EXPECT_LT((back.cameras[1].T_camera_rig.matrix() - wanted.matrix()).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace softforce
