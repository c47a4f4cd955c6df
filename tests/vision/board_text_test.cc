#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "softforce/base/input_error.h"
#include "softforce/vision/board.h"

namespace softforce::vision {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Refusal(const std::string& text) {
  try {
    ParseBoard(text);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParseBoard, ReadsEveryKindAndWritesItBack) {
  for (const char* text :
       {"chessboard:9x6,square=20mm", "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50",
        "charuco:8x6,square=12.5mm,marker=9mm,dictionary=5X5_100,legacy",
        "aprilgrid:6x6,tag=24mm,spacing=0.3",
        "aprilgrid:3x2,tag=30mm,spacing=0.25,family=tag25h9,first=4",
        "circles:4x11,spacing=20mm,diameter=14mm"}) {
    EXPECT_EQ(ParseBoard(text).Text(), text);
  }
}

TEST(ParseBoard, ToleratesSpacesCaseAndOtherUnits) {
  EXPECT_EQ(ParseBoard(" Chessboard : 9 X 6 , square = 0.02 m ").Text(),
            "chessboard:9x6,square=20mm");
  EXPECT_EQ(ParseBoard("charuco:7x10, marker=15 mm, square=2cm, dictionary=dict_4x4_50").Text(),
            "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50");
}

TEST(ParseBoard, TakesTheGapOfAnAprilGridAsALengthToo) {
  EXPECT_NEAR(ParseBoard("aprilgrid:6x6,tag=24mm,spacing=7.2mm").gap_ratio, 0.3, 1e-12);
}

TEST(ParseBoard, SaysHowToWriteWhatItCannotRead) {
  EXPECT_THAT(Refusal("checkerboard:9x6,square=20mm"),
              AllOf(HasSubstr("--board"), HasSubstr("\"checkerboard\""),
                    HasSubstr("chessboard, charuco, aprilgrid or circles")));
  EXPECT_THAT(Refusal("chessboard"), HasSubstr("expects columns x rows"));
  EXPECT_THAT(Refusal("chessboard:9by6,square=20mm"), HasSubstr("\"9by6\""));
  EXPECT_THAT(Refusal("chessboard:9x6"), HasSubstr("\"square\" is missing"));
  EXPECT_THAT(Refusal("chessboard:9x6,square"), HasSubstr("\"square\" has no value"));
  EXPECT_THAT(Refusal("chessboard:9x6,square=20"), HasSubstr("no unit"));
  EXPECT_THAT(Refusal("chessboard:9x6,square=20 N"), HasSubstr("a length"));
  EXPECT_THAT(Refusal("chessboard:9x6,square=20mm,squares=3"),
              AllOf(HasSubstr("\"squares\" is no entry"), HasSubstr("expected square")));
  EXPECT_THAT(Refusal("chessboard:9x6,square=20mm,square=30mm"), HasSubstr("given twice"));
  EXPECT_THAT(Refusal("charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50,legacy=yes"),
              HasSubstr("expected true or false"));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=24mm,spacing=0.3,first=1.5"), HasSubstr("whole number"));
}

TEST(ParseBoard, TellsWhatItCountsWhereThatIsEasilyMistaken) {
  EXPECT_THAT(Refusal("chessboard:9,square=20mm"), HasSubstr("INNER corners"));
  EXPECT_THAT(Refusal("charuco:7,square=20mm"), HasSubstr("SQUARES (not inner corners)"));
}

TEST(ParseBoard, RefusesBoardsThatCannotBe) {
  EXPECT_THAT(Refusal("chessboard:2x6,square=20mm"), HasSubstr("has 2x6 inner corners"));
  EXPECT_THAT(Refusal("chessboard:9x101,square=20mm"), HasSubstr("3x3 to 100x100"));
  EXPECT_THAT(Refusal("chessboard:9x6,square=0mm"), HasSubstr("square is 0 mm, must be > 0"));
  EXPECT_THAT(Refusal("charuco:2x10,square=20mm,marker=15mm,dictionary=4X4_50"),
              HasSubstr("has 2x10 squares"));
  EXPECT_THAT(Refusal("charuco:7x10,square=-1mm,marker=15mm,dictionary=4X4_50"),
              HasSubstr("square is -1 mm"));
  EXPECT_THAT(Refusal("charuco:7x10,square=20mm,marker=0mm,dictionary=4X4_50"),
              HasSubstr("marker is 0 mm"));
  EXPECT_THAT(Refusal("charuco:7x10,square=20mm,marker=20mm,dictionary=4X4_50"),
              HasSubstr("marker (20 mm) must be smaller than square (20 mm)"));
  EXPECT_THAT(Refusal("charuco:7x10,square=20mm,marker=15mm,dictionary=9X9_50"),
              AllOf(HasSubstr("\"9X9_50\" is not known"), HasSubstr("4X4_50")));
  EXPECT_THAT(Refusal("charuco:12x10,square=20mm,marker=15mm,dictionary=4X4_50"),
              HasSubstr("carry 60 markers, but dictionary 4X4_50 has 50"));
  EXPECT_THAT(Refusal("aprilgrid:0x6,tag=24mm,spacing=0.3"), HasSubstr("has 0x6 tags"));
  EXPECT_THAT(Refusal("aprilgrid:1x1,tag=24mm,spacing=0.3"), HasSubstr("at least 2"));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=0mm,spacing=0.3"), HasSubstr("tag is 0 mm"));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=24mm,spacing=0"), HasSubstr("Kalibr's tagSpacing"));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=24mm,spacing=1.1"), HasSubstr("at most 1"));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=24mm,spacing=0.3,family=tag36h10"),
              HasSubstr("\"tag36h10\""));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=24mm,spacing=0.3,family=tagStandard41h12"),
              HasSubstr("white border"));
  EXPECT_THAT(Refusal("aprilgrid:6x6,tag=24mm,spacing=0.3,family=tag16h5"),
              HasSubstr("its ids are 0 to 29"));
  EXPECT_THAT(Refusal("circles:1x11,spacing=20mm,diameter=14mm"), HasSubstr("has 1x11 circles"));
  EXPECT_THAT(Refusal("circles:4x11,spacing=0mm,diameter=14mm"), HasSubstr("spacing is 0 mm"));
  EXPECT_THAT(Refusal("circles:4x11,spacing=20mm,diameter=0mm"), HasSubstr("diameter is 0 mm"));
  EXPECT_THAT(Refusal("circles:4x11,spacing=20mm,diameter=29mm"),
              HasSubstr("diameter (29 mm) must be smaller than the circles' distance (28.28"));
}

class KalibrTarget : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) {
    const auto path =
        std::filesystem::path(::testing::TempDir()) /
        (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".yaml");
    std::ofstream(path) << text;
    return path.string();
  }
};

TEST_F(KalibrTarget, IsReadFromItsFile) {
  const std::string grid = Write(
      "target_type: 'aprilgrid' #gridtype\ntagCols: 6\ntagRows: 5\ntagSize: 0.088 #m\n"
      "tagSpacing: 0.3\n");
  EXPECT_EQ(ParseBoard(grid).Text(), "aprilgrid:6x5,tag=88mm,spacing=0.3");
  const std::string chessboard = Write(
      "target_type: 'checkerboard'\ntargetCols: 6\ntargetRows: 7\nrowSpacingMeters: 0.06\n"
      "colSpacingMeters: 0.06\n");
  EXPECT_EQ(ParseBoard(chessboard).Text(), "chessboard:6x7,square=60mm");
}

TEST_F(KalibrTarget, IsRefusedWithTheFilesNameAndTheFix) {
  EXPECT_THAT(Refusal("/nowhere/target.yaml"),
              AllOf(HasSubstr("/nowhere/target.yaml"), HasSubstr("cannot be opened")));
  const std::string start = "target_type: 'aprilgrid'\ntagCols: 6\n";
  EXPECT_THAT(Refusal(Write(start)),
              AllOf(HasSubstr(".yaml"), HasSubstr("\"tagRows\" is missing")));
  EXPECT_THAT(Refusal(Write(start + "tagRows: six\n")), HasSubstr("tagRows"));
  EXPECT_THAT(Refusal(Write("[1, 2]")), HasSubstr("is not a target file"));
  EXPECT_THAT(Refusal(Write("a: [1")), HasSubstr("is not YAML"));
  EXPECT_THAT(Refusal(Write("target_type: circlegrid\n")), HasSubstr("circles:4x11"));
  EXPECT_THAT(Refusal(Write("target_type: checkerboard\ntargetCols: 6\ntargetRows: 7\n"
                            "rowSpacingMeters: 0.06\ncolSpacingMeters: 0.05\n")),
              HasSubstr("expected squares"));
  EXPECT_THAT(Refusal(Write(start + "tagRows: 6\ntagSize: 0.02\ntagSpacing: 30\n")),
              HasSubstr("spacing is 30"));
}

TEST(Board, HasItsPointsWhereOpenCvHasThem) {
  const Board chessboard = ParseBoard("chessboard:9x6,square=20mm");
  EXPECT_EQ(chessboard.NumPoints(), 54);
  EXPECT_TRUE(chessboard.Point(10).isApprox(Eigen::Vector3d(0.02, 0.02, 0)));
  const Board charuco = ParseBoard("charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50");
  EXPECT_EQ(charuco.NumPoints(), 54);
  EXPECT_TRUE(charuco.Point(0).isApprox(Eigen::Vector3d(0.02, 0.02, 0)));
  EXPECT_TRUE(charuco.Point(7).isApprox(Eigen::Vector3d(0.04, 0.04, 0)));
  const Board circles = ParseBoard("circles:4x11,spacing=20mm,diameter=14mm");
  EXPECT_EQ(circles.NumPoints(), 44);
  EXPECT_TRUE(circles.Point(1).isApprox(Eigen::Vector3d(0.04, 0, 0)));
  EXPECT_TRUE(circles.Point(4).isApprox(Eigen::Vector3d(0.02, 0.02, 0)));
}

TEST(Board, HasItsPointsWhereKalibrHasThem) {
  const Board grid = ParseBoard("aprilgrid:6x6,tag=24mm,spacing=0.3");
  EXPECT_EQ(grid.NumPoints(), 144);
  EXPECT_TRUE(grid.Point(1).isApprox(Eigen::Vector3d(0.024, 0, 0)));
  EXPECT_TRUE(grid.Point(2).isApprox(Eigen::Vector3d(0.0312, 0, 0)));
  EXPECT_TRUE(grid.Point(12).isApprox(Eigen::Vector3d(0, 0.024, 0)));
  EXPECT_EQ(grid.Points().size(), 144u);
}

TEST(Board, KnowsWhetherItLooksAlikeWhenTurned) {
  EXPECT_FALSE(ParseBoard("chessboard:9x6,square=20mm").LooksAlikeWhenTurned());
  EXPECT_TRUE(ParseBoard("chessboard:8x6,square=20mm").LooksAlikeWhenTurned());
  EXPECT_TRUE(ParseBoard("chessboard:7x7,square=20mm").LooksAlikeWhenTurned());
  EXPECT_FALSE(ParseBoard("circles:4x11,spacing=20mm,diameter=14mm").LooksAlikeWhenTurned());
  EXPECT_TRUE(ParseBoard("circles:4x10,spacing=20mm,diameter=14mm").LooksAlikeWhenTurned());
}

}  // namespace
}  // namespace softforce::vision
