#include "softforce/vision/board_hint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vision/board_painter.h"

namespace softforce::vision {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

cv::Mat PictureOf(const char* board, double scale) {
  const testing::PrintedBoard printed{ParseBoard(board)};
  testing::SyntheticScene scene(300, 240, 90);
  PaintBoard(printed, testing::LookAt(printed.board, {150, 120}, scale), &scene);
  std::mt19937 random(1);
  return scene.TakePicture(2, random);
}

TEST(ExplainMissingBoard, KnowsSquaresCountedForInnerCorners) {
  const auto picture = PictureOf("chessboard:6x5,square=20mm", 1300);
  EXPECT_THAT(ExplainMissingBoard(picture, ParseBoard("chessboard:7x6,square=20mm")),
              AllOf(HasSubstr("chessboard:6x5,square=20mm"), HasSubstr("not squares")));
}

TEST(ExplainMissingBoard, KnowsMarkersOfAnotherDictionary) {
  const auto picture = PictureOf("charuco:5x4,square=20mm,marker=15mm,dictionary=4X4_50", 2000);
  EXPECT_THAT(ExplainMissingBoard(
                  picture, ParseBoard("charuco:5x4,square=20mm,marker=15mm,dictionary=6X6_250")),
              AllOf(HasSubstr("dictionary=4X4"), HasSubstr("another dictionary")));
}

TEST(ExplainMissingBoard, KnowsTagsOfAnotherFamily) {
  const auto picture = PictureOf("aprilgrid:3x2,tag=24mm,spacing=0.3,family=tag25h9", 2500);
  EXPECT_THAT(ExplainMissingBoard(picture, ParseBoard("aprilgrid:3x2,tag=24mm,spacing=0.3")),
              HasSubstr("family=tag25h9"));
}

TEST(ExplainMissingBoard, HasNothingToSayOfAPictureWithoutABoard) {
  std::mt19937 random(4);
  const auto noise = testing::SyntheticScene(300, 240, 128).TakePicture(40, random);
  EXPECT_EQ(ExplainMissingBoard(noise, ParseBoard("chessboard:7x6,square=20mm")), "");
}

}  // namespace
}  // namespace softforce::vision
