#include "softforce/vision/board_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include "softforce/base/input_error.h"
#include "vision/board_painter.h"

namespace softforce::vision {
namespace {

using testing::BoardSight;
using ::testing::HasSubstr;
using testing::LookAt;
using testing::PrintedBoard;
using testing::SyntheticScene;

constexpr double kNoise = 2;  // grey levels

Eigen::Matrix3d Turn(double about_x, double about_y, double about_z) {
  return (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

cv::Mat PictureOf(const PrintedBoard& printed, const BoardSight& sight, int width, int height,
                  double blur = 0.65) {
  SyntheticScene scene(width, height, 90, blur);
  PaintBoard(printed, sight, &scene);
  std::mt19937 random(1);
  return scene.TakePicture(kNoise, random);
}

struct Errors {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  // px
  double rms = 0;                                  // px, of one axis
  double normalised = 0;  // mean square error over its own covariance; 1 if that is honest
};

Errors ErrorsOf(const BoardView& view, const Board& board, const BoardSight& sight) {
  Errors errors;
  for (int k = 0; k < view.size(); ++k) {
    const Eigen::Vector2d error = view.pixels[k] - sight.Pixel(board.Point(view.ids[k]));
    errors.mean += error / view.size();
    errors.rms += 0.5 * error.squaredNorm() / view.size();
    errors.normalised += 0.5 * error.dot(view.covariances[k].inverse() * error) / view.size();
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

struct Case {
  const char* text;
  double scale;  // px/m
};

class EveryBoard : public ::testing::TestWithParam<Case> {};

TEST_P(EveryBoard, IsMeasuredToASmallPartOfAPixel) {
  const PrintedBoard printed{ParseBoard(GetParam().text)};
  const BoardSight sight =
      LookAt(printed.board, {200.3, 160.6}, GetParam().scale, Turn(0.35, -0.3, 0.1));

  const BoardDetection detection = DetectBoard(PictureOf(printed, sight, 400, 320), printed.board);

  ASSERT_TRUE(detection.ok()) << detection.reason;
  EXPECT_EQ(detection.view.size(), printed.board.NumPoints());
  const Errors errors = ErrorsOf(detection.view, printed.board, sight);
  RecordProperty("rms_px", std::to_string(errors.rms));
  RecordProperty("normalised", std::to_string(errors.normalised));
  // px; AprilTag's and OpenCV 4.6's ChArUco conventions would each give 0.5.
  EXPECT_LT(errors.mean.norm(), 0.02);
  EXPECT_LT(errors.rms, 0.03);  // px; noise alone makes 0.01 to 0.02 of squares so small
  EXPECT_GT(errors.normalised, 0.4);
  EXPECT_LT(errors.normalised, 2);
}

TEST_P(EveryBoard, IsNotSeenInNoise) {
  std::mt19937 random(4);
  const cv::Mat noise = SyntheticScene(400, 320, 128).TakePicture(60, random);
  const BoardDetection detection = DetectBoard(noise, ParseBoard(GetParam().text));
  EXPECT_EQ(detection.status, BoardDetection::Status::kNotFound);
  EXPECT_NE(detection.reason, "");
  EXPECT_EQ(detection.view.size(), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryBoard,
    ::testing::Values(Case{"chessboard:7x5,square=20mm", 1500},
                      Case{"charuco:7x5,square=20mm,marker=15mm,dictionary=4X4_50", 2200},
                      Case{"aprilgrid:3x2,tag=24mm,spacing=0.3", 3000},
                      Case{"circles:3x7,spacing=10mm,diameter=10mm", 2800}));

TEST(DetectBoard, GivesAChessboardTheSameIdsWhicheverWayUp) {
  const PrintedBoard printed{ParseBoard("chessboard:6x5,square=20mm")};
  for (const double turn : {0.0, M_PI / 2, M_PI, 4.0}) {
    const BoardSight sight = LookAt(printed.board, {150, 150}, 1200, Turn(0.1, 0.2, turn));
    const auto detection = DetectBoard(PictureOf(printed, sight, 300, 300), printed.board);
    ASSERT_TRUE(detection.ok()) << detection.reason;
    EXPECT_LT(ErrorsOf(detection.view, printed.board, sight).rms, 0.1) << turn;  // px
  }
}

TEST(DetectBoard, TakesAChessboardThatLooksAlikeWhenTurnedAsUpright) {
  for (const bool white : {false, true}) {
    PrintedBoard printed{ParseBoard("chessboard:6x4,square=20mm")};
    printed.top_left_white = white;
    for (const double turn : {0.6, M_PI + 0.6}) {
      const auto picture = PictureOf(
          printed, LookAt(printed.board, {150, 150}, 1200, Turn(0.1, 0.2, turn)), 300, 300);
      const auto detection = DetectBoard(picture, printed.board);
      ASSERT_TRUE(detection.ok()) << detection.reason;
      EXPECT_GT(detection.view.pixels[5].x(), detection.view.pixels[0].x()) << turn;
    }
  }
}

TEST(DetectBoard, LaysASquareChessboardsFirstCornerAtABlackSquare) {
  // Two opposite corners of this board are black. Of these, the upper left one is meant, which
  // after a quarter turn and a bit is the other one.
  const PrintedBoard printed{ParseBoard("chessboard:5x5,square=20mm")};
  const BoardSight sight = LookAt(printed.board, {150, 150}, 1200, Turn(0.1, 0.2, M_PI / 2 + 0.3));

  auto detection = DetectBoard(PictureOf(printed, sight, 300, 300), printed.board);

  ASSERT_TRUE(detection.ok()) << detection.reason;
  for (int& id : detection.view.ids) id = printed.board.NumPoints() - 1 - id;
  EXPECT_LT(ErrorsOf(detection.view, printed.board, sight).rms, 0.1);  // px
}

TEST(DetectBoard, SeesPartOfACharucoBoard) {
  const PrintedBoard printed{ParseBoard("charuco:7x5,square=20mm,marker=15mm,dictionary=4X4_50")};
  const BoardSight sight = LookAt(printed.board, {60, 160}, 2500, Turn(0.2, 0, 2.0));
  const auto detection = DetectBoard(PictureOf(printed, sight, 300, 300), printed.board);
  ASSERT_TRUE(detection.ok()) << detection.reason;
  EXPECT_LT(detection.view.size(), printed.board.NumPoints());
  EXPECT_GE(detection.view.size(), 8);
  EXPECT_LT(ErrorsOf(detection.view, printed.board, sight).rms, 0.04);  // px
}

TEST(DetectBoard, KnowsCharucoBoardsOfOlderOpenCv) {
  const char* text = "charuco:5x4,square=20mm,marker=15mm,dictionary=4X4_50";
  PrintedBoard printed{ParseBoard(std::string(text) + ",legacy")};
  const BoardSight sight = LookAt(printed.board, {150, 150}, 2200);
  const cv::Mat picture = PictureOf(printed, sight, 300, 300);

  const auto detection = DetectBoard(picture, printed.board);

  ASSERT_TRUE(detection.ok()) << detection.reason;
  EXPECT_LT(ErrorsOf(detection.view, printed.board, sight).rms, 0.04);  // px
  const auto mistaken = DetectBoard(picture, ParseBoard(text));
  EXPECT_EQ(mistaken.status, BoardDetection::Status::kNotFound);
  EXPECT_THAT(mistaken.reason, HasSubstr(",legacy"));
}

TEST(DetectBoard, ReadsAprilGridsWithEitherBorderAndEitherWayUp) {
  for (const int black_border : {1, 2}) {
    for (const bool upright : {false, true}) {
      PrintedBoard printed{ParseBoard("aprilgrid:3x2,tag=24mm,spacing=0.3,first=7")};
      printed.black_border = black_border;
      printed.tags_upright = upright;
      const BoardSight sight = LookAt(printed.board, {160, 120}, 2800, Turn(0.2, 0.2, 0.1));
      const auto detection = DetectBoard(PictureOf(printed, sight, 320, 240), printed.board);
      ASSERT_TRUE(detection.ok()) << black_border << upright << detection.reason;
      EXPECT_EQ(detection.view.size(), printed.board.NumPoints());
      EXPECT_LT(ErrorsOf(detection.view, printed.board, sight).rms, 0.04);  // px
    }
  }
}

TEST(DetectBoard, SeesPartOfAnAprilGrid) {
  const PrintedBoard printed{ParseBoard("aprilgrid:3x2,tag=24mm,spacing=0.3")};
  const BoardSight sight = LookAt(printed.board, {90, 120}, 3000);
  cv::Mat picture = PictureOf(printed, sight, 320, 240);
  const auto detection = DetectBoard(picture, printed.board);
  ASSERT_TRUE(detection.ok()) << detection.reason;
  EXPECT_LT(detection.view.size(), printed.board.NumPoints());
  EXPECT_LT(ErrorsOf(detection.view, printed.board, sight).rms, 0.04);  // px
}

TEST(DetectBoard, LeavesOutCornersThatAreCovered) {
  const PrintedBoard printed{ParseBoard("chessboard:7x5,square=20mm")};
  const BoardSight sight = LookAt(printed.board, {200, 160}, 1800, Turn(0.1, 0, 0));
  cv::Mat picture = PictureOf(printed, sight, 400, 320);
  const Eigen::Vector2d corner = sight.Pixel(printed.board.Point(17));
  // A highlight that OpenCV's detector overlooks, but that moves the corner.
  cv::circle(picture, cv::Point(cvRound(corner.x()) + 9, cvRound(corner.y()) - 7), 8, 250, -1);
  const auto detection = DetectBoard(picture, printed.board);
  ASSERT_TRUE(detection.ok()) << detection.reason;
  for (int k = 0; k < detection.view.size(); ++k) {
    const double error =
        (detection.view.pixels[k] - sight.Pixel(printed.board.Point(detection.view.ids[k]))).norm();
    EXPECT_LT(error, 0.3) << detection.view.ids[k];  // px
  }
}

TEST(DetectBoard, MeasuresTheBlur) {
  const PrintedBoard printed{ParseBoard("chessboard:5x4,square=20mm")};
  const BoardSight sight = LookAt(printed.board, {150, 150}, 1500);
  for (const double blur : {0.6, 1.5, 2.5}) {
    const auto detection = DetectBoard(PictureOf(printed, sight, 300, 300, blur), printed.board);
    ASSERT_TRUE(detection.ok()) << detection.reason;
    // The pixel's own width adds its standard deviation, 1/√12.
    EXPECT_NEAR(detection.blur, std::hypot(blur, std::sqrt(1.0 / 12)), 0.05);  // px
    EXPECT_NEAR(detection.cell, 30, 0.1);                                      // px
  }
}

TEST(DetectBoard, SaysWhatItLookedFor) {
  const PrintedBoard printed{ParseBoard("chessboard:6x5,square=20mm")};
  const auto picture = PictureOf(printed, LookAt(printed.board, {150, 150}, 1300), 300, 300);
  const auto detection = DetectBoard(picture, ParseBoard("chessboard:9x6,square=20mm"));
  EXPECT_EQ(detection.status, BoardDetection::Status::kNotFound);
  EXPECT_THAT(detection.reason, HasSubstr("9x6 inner corners"));
}

TEST(DetectBoard, DoesNotReportAHandfulOfPoints) {
  const PrintedBoard printed{ParseBoard("chessboard:5x4,square=20mm")};
  const auto picture = PictureOf(printed, LookAt(printed.board, {150, 150}, 1500), 300, 300);
  BoardOptions options;
  options.min_points = 21;
  const auto detection = DetectBoard(picture, printed.board, options);
  EXPECT_EQ(detection.status, BoardDetection::Status::kTooFewPoints);
  EXPECT_THAT(detection.reason, HasSubstr("20 of the board's 20 points"));
}

TEST(BoardOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](auto change) {
    BoardOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(BoardOptions().Check());
  refuses([](BoardOptions& o) { o.min_points = 3; });
  refuses([](BoardOptions& o) { o.max_window = 0; });
  refuses([](BoardOptions& o) { o.max_window = 1.1; });
  refuses([](BoardOptions& o) { o.max_window_px = 2; });
  refuses([](BoardOptions& o) { o.min_contrast = 0; });
  refuses([](BoardOptions& o) { o.border = -1; });
}

}  // namespace
}  // namespace softforce::vision
