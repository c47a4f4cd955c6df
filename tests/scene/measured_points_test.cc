#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

using ::testing::HasSubstr;
using testing::Refusal;
using ::testing::StartsWith;
using testing::TempFolder;
using testing::WriteFile;

// Laid out as Motive lays out an export: a rigid body, which is of no use here, three markers of
// which one has no label, and a frame in which one of them is not seen.
constexpr char kTake[] =
    "Format Version,1.23,Take Name,\"pull, slow\",Take Notes,,Capture Frame Rate,100.000000,"
    "Export Frame Rate,100.000000,Capture Start Time,2024-05-02 03.12.10.000 "
    "PM,Total Exported Frames,2,Rotation Type,Quaternion,Length Units,Millimeters,Coordinate "
    "Space,Global\r\n"
    "\r\n"
    ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid "
    "Body,Rigid Body Marker,Rigid Body Marker,Rigid Body "
    "Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker\r\n"
    ",Name,Base,Base,Base,Base,Base,Base,Base,Base,Base:Marker1,Base:Marker1,Base:Marker1,"
    "Sheet:tip,Sheet:tip,Sheet:tip,7,7,7,Unlabeled 1042,Unlabeled 1042,Unlabeled 1042\r\n"
    ",ID,\"1A\",\"1A\",\"1A\",\"1A\",\"1A\",\"1A\",\"1A\",\"1A\",\"2B\",\"2B\",\"2B\",\"3C\","
    "\"3C\",\"3C\",\"4D\",\"4D\",\"4D\",\"5E\",\"5E\",\"5E\"\r\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker "
    "Error,Position,Position,Position,Position,Position,Position,Position,Position,Position,"
    "Position,Position,Position\r\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z,X,Y,Z,X,Y,Z,X,Y,Z\r\n"
    "0,0.000000,0,0,0,1,5,6,7,0.1,5,6,7,10.5,-20.25,30,1,2,3,100,200,300\r\n"
    "1,0.010000,0,0,0,1,5,6,7,0.1,5,6,7,10.75,-20.25,30,,,,100,200,300\r\n";

Markers TwoMarkers() {
  Markers markers;
  markers.points = {{0, {}, "tip"}, {7, {}, "7"}};
  return markers;
}

MeasuredPoints Read(const std::string& text, Measured measured = {}) {
  measured.file = WriteFile(TempFolder() / "take.csv", text);
  return ReadMeasuredPoints(measured, TwoMarkers());
}

std::string RefusalOf(const std::string& text, const Measured& measured = {}) {
  return Refusal([&] { Read(text, measured); });
}

Measured InUnit(double metres) {
  Measured measured;
  measured.metres_per_unit = metres;
  return measured;
}

TEST(MotiveExport, IsReadAsItComes) {
  const MeasuredPoints take = Read(kTake);

  EXPECT_EQ(take.format, "Motive 1.23");
  ASSERT_EQ(take.frames.size(), 2u);
  EXPECT_EQ(take.frames[1].frame, 1);
  EXPECT_EQ(take.frames[1].time_s, 0.01);
  const std::vector<MeasuredPoint>& points = take.frames[0].points;
  ASSERT_EQ(points.size(), 3u);  // none of the rigid body
  EXPECT_EQ(points[0].marker, 0);
  EXPECT_TRUE(points[0].p_rig.isApprox(Eigen::Vector3d(0.0105, -0.02025, 0.03)));
  EXPECT_EQ(points[0].sd, Measured().noise);
  EXPECT_EQ(points[1].marker, 1);
  EXPECT_EQ(points[2].marker, -1);
}

TEST(MotiveExport, LeavesOutPointsThatWereNotSeen) {
  const std::vector<MeasuredPoint> points = Read(kTake).frames[1].points;

  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].marker, 0);
  EXPECT_EQ(points[1].marker, -1);
}

TEST(MotiveExport, HasItsOwnUnit) {
  const MeasuredPoints take = Read(testing::Replaced(kTake, "Millimeters", "Meters"));

  EXPECT_EQ(take.frames[0].points[1].p_rig, Eigen::Vector3d(1, 2, 3));
}

TEST(MotiveExport, MayHaveTimeCodesAndParents) {
  const std::string text =
      "Format Version,1.25,Length Units,Centimeters,Coordinate Space,Global\n"
      ",Type,,Marker,Marker,Marker\n"
      ",Name,,7,7,7\n"
      ",ID,,A,A,A\n"
      ",Parent,,Sheet,Sheet,Sheet\n"
      ",,,Position,Position,Position\n"
      "Frame,Time (Seconds),TimeCode,X,Y,Z\n"
      "12,0.1,15:26:46:12.02,1,2,3\n";

  const MeasuredPoints take = Read(text);

  EXPECT_EQ(take.frames.at(0).frame, 12);
  EXPECT_TRUE(take.frames[0].points.at(0).p_rig.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03)));
}

// All that version 1.25 can put beside the markers: a byte order mark, a rigid body with rotation
// and error, where it expects its markers (with a quality each), sizes of markers, and points
// without a label that appear and vanish; rows end where nothing more was seen. The axis that
// points up is y.
constexpr char kFullTake[] =
    "\xEF\xBB\xBF"
    "Format Version,1.25,Take Name,Pull 3,Take Notes,,Capture Frame Rate,240.000000,Export Frame "
    "Rate,120.000000,Capture Start Time,2025-03-14 10.01.02.345 AM,Capture Start Frame,0,Total "
    "Frames in Take,3,Total Exported Frames,3,Rotation Type,Quaternion,Length "
    "Units,Centimeters,Coordinate Space,Global\n"
    "\n"
    ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,"
    "Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,"
    "Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker\n"
    ",Name,Base,Base,Base,Base,Base,Base,Base,Base,"
    "Base:Marker 001,Base:Marker 001,Base:Marker 001,Base:Marker 001,"
    "\"Sheet:tip\",\"Sheet:tip\",\"Sheet:tip\",\"Sheet:tip\",Unlabeled 1189,Unlabeled 1189,"
    "Unlabeled 1189,Unlabeled 1189,Unlabeled 1203,Unlabeled 1203,Unlabeled 1203,Unlabeled 1203\n"
    ",ID,\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"B\",\"B\",\"B\",\"B\","
    "\"C\",\"C\",\"C\",\"C\",\"D\",\"D\",\"D\",\"D\",\"E\",\"E\",\"E\",\"E\"\n"
    ",Parent,,,,,,,,,\"A\",\"A\",\"A\",\"A\",,,,,,,,,,,,\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,"
    "Position,Position,Position,Marker Quality,Position,Position,Position,Size,"
    "Position,Position,Position,Size,Position,Position,Position,Size\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z,,X,Y,Z,,X,Y,Z,,X,Y,Z,\n"
    "0,0.000000,0,0,0,1,5,6,7,0.1,5,6,7,1,10.5,20,30,0.6,1,2,3,0.6,,,,\n"
    "1,0.008333,0,0,0,1,5,6,7,0.1,5,6,7,1,,,,,1,2.5,3,0.6,7,8,9,0.6\n"
    "2,0.016667,,,,,,,,,,,,,10.5,21,30,0.6\n";

TEST(MotiveExport, MayHaveRigidBodiesErrorsSizesAndPointsThatComeAndGo) {
  const MeasuredPoints take = Read(kFullTake);

  EXPECT_EQ(take.format, "Motive 1.25");
  ASSERT_EQ(take.frames.size(), 3u);
  const auto points = [&](int frame) { return take.frames[frame].points; };
  ASSERT_EQ(points(0).size(), 2u);
  EXPECT_EQ(points(0)[0].marker, 0);
  EXPECT_TRUE(points(0)[0].p_rig.isApprox(Eigen::Vector3d(0.105, 0.2, 0.3)));  // m; axes as written
  EXPECT_EQ(points(0)[1].marker, -1);
  ASSERT_EQ(points(1).size(), 2u);
  EXPECT_TRUE(points(1)[0].p_rig.isApprox(Eigen::Vector3d(0.01, 0.025, 0.03)));
  EXPECT_TRUE(points(1)[1].p_rig.isApprox(Eigen::Vector3d(0.07, 0.08, 0.09)));
  ASSERT_EQ(points(2).size(), 1u);
  EXPECT_EQ(points(2)[0].marker, 0);
}

TEST(MotiveExport, CanBeTakenWithoutItsLabels) {
  Measured measured;
  measured.labels = false;

  for (const MeasuredPoint& point : Read(kTake, measured).frames[0].points) {
    EXPECT_EQ(point.marker, -1);
  }
}

TEST(MotiveExport, LeavesOutPointsThatTheSceneIgnores) {
  Measured measured;
  measured.ignore = {"Sheet:tip"};

  EXPECT_EQ(Read(kTake, measured).frames[0].points.size(), 2u);
}

TEST(MotiveExport, RefusesAnUnknownUnit) {
  EXPECT_THAT(RefusalOf(testing::Replaced(kTake, "Millimeters", "Furlongs")),
              StartsWith("take.csv:1: Length Units: got \"Furlongs\", expected Millimeters, "
                         "Centimeters or Meters\n  Export"));
}

TEST(MotiveExport, RefusesAUnitThatIsNotTheScenes) {
  EXPECT_THAT(RefusalOf(kTake, InUnit(1)),
              StartsWith("take.csv:1: Length Units: got Millimeters, but the scene says"));
}

TEST(MotiveExport, RefusesLocalCoordinates) {
  EXPECT_THAT(RefusalOf(testing::Replaced(kTake, "Global", "Local")),
              StartsWith("take.csv:1: Coordinate Space: got \"Local\", expected Global"));
}

TEST(MotiveExport, RefusesALabelThatIsNoMarker) {
  const std::string text =
      testing::Replaced(kTake, "tip,Sheet:tip,Sheet:tip", "top,Sheet:top,Sheet:top");

  EXPECT_EQ(RefusalOf(text),
            "take.csv:4: column 14: got a point called \"Sheet:top\", expected tip, 7\n"
            "  Did you mean \"tip\"? Give a marker of the scene this \"label\", list it under "
            "\"measured: ignore\", or set \"measured: labels\" to false.");
}

TEST(MotiveExport, RefusesTimesThatDoNotAscend) {
  EXPECT_EQ(RefusalOf(testing::Replaced(kTake, "0.010000", "0.000000")),
            "take.csv:9: got the time 0 s after 0 s, expected ascending times");
}

TEST(MotiveExport, RefusesAPointOfWhichACoordinateIsMissing) {
  EXPECT_EQ(RefusalOf(testing::Replaced(kTake, "10.75,-20.25,", "10.75,,")),
            "take.csv:9: got 2 of the three coordinates of the point \"Sheet:tip\", expected all, "
            "or none for a point that was not seen");
}

TEST(MotiveExport, RefusesRigidBodiesAlone) {
  const std::string text =
      "Format Version,1.23,Length Units,Meters\n"
      ",Type,Rigid Body,Rigid Body,Rigid Body\n,Name,Base,Base,Base\n,ID,A,A,A\n"
      ",,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z\n0,0,1,2,3\n";

  EXPECT_THAT(RefusalOf(text), StartsWith("take.csv: got no columns of markers' positions"));
}

TEST(PointTable, MayHaveARowForEveryPoint) {
  const MeasuredPoints table = Read(
      "frame,time_s,marker,x_mm,y_mm,z_mm,sd_mm\n"
      "3,0.1,tip,1,2,3,0.05\n"
      "3,0.1,,4,5,6,\n"
      "5,0.2,7,7,8,9,0.05\n");

  ASSERT_EQ(table.frames.size(), 2u);
  EXPECT_EQ(table.frames[0].frame, 3);
  ASSERT_EQ(table.frames[0].points.size(), 2u);
  EXPECT_EQ(table.frames[0].points[0].marker, 0);
  EXPECT_DOUBLE_EQ(table.frames[0].points[0].sd, 0.05e-3);
  EXPECT_TRUE(table.frames[0].points[0].p_rig.isApprox(Eigen::Vector3d(1e-3, 2e-3, 3e-3)));
  EXPECT_EQ(table.frames[0].points[1].marker, -1);
  EXPECT_EQ(table.frames[0].points[1].sd, Measured().noise);
  EXPECT_EQ(table.frames[1].points[0].marker, 1);
}

TEST(PointTable, MayHaveNoLabelsAtAll) {
  const MeasuredPoints table = Read("t,x_m,y_m,z_m\n0,1,2,3\n0,4,5,6\n0.5,1,2,3\n");

  ASSERT_EQ(table.frames.size(), 2u);
  EXPECT_EQ(table.frames[0].points.size(), 2u);
  EXPECT_EQ(table.frames[1].frame, 1);
}

TEST(PointTable, MayHaveARowForEveryFrame) {
  const MeasuredPoints table = Read(
      "time_s,tip_x_cm,tip_y_cm,tip_z_cm,7_x_cm,7_y_cm,7_z_cm\n"
      "0,1,2,3,4,5,6\n"
      "1,,,,4,5,6\n"
      "2,1,2,3,NaN,NaN,NaN\n");

  ASSERT_EQ(table.frames.size(), 3u);
  ASSERT_EQ(table.frames[0].points.size(), 2u);
  EXPECT_TRUE(table.frames[0].points[1].p_rig.isApprox(Eigen::Vector3d(0.04, 0.05, 0.06)));
  ASSERT_EQ(table.frames[1].points.size(), 1u);
  EXPECT_EQ(table.frames[1].points[0].marker, 1);
  ASSERT_EQ(table.frames[2].points.size(), 1u);
  EXPECT_EQ(table.frames[2].points[0].marker, 0);
}

TEST(PointTable, TakesTheUnitAndTheRateOfTheScene) {
  Measured measured = InUnit(1e-2);
  measured.rate = 50;

  const MeasuredPoints table = Read("frame,marker,x,y,z\n10,tip,1,2,3\n", measured);

  EXPECT_DOUBLE_EQ(table.frames.at(0).time_s, 0.2);
  EXPECT_TRUE(table.frames[0].points.at(0).p_rig.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03)));
}

TEST(PointTable, TakesRowsOfCommasThatSpreadsheetsLeave) {
  EXPECT_EQ(Read("time_s,x_mm,y_mm,z_mm\n0,1,2,3\n,,,\n").frames.size(), 1u);
}

TEST(PointTable, RefusesALengthWithoutUnit) {
  EXPECT_THAT(RefusalOf("time_s,x,y,z\n0,1,2,3\n"),
              StartsWith("take.csv:1: column \"x\": got a length without unit, expected x_mm"));
}

TEST(PointTable, RefusesAUnitThatIsNotTheScenes) {
  EXPECT_THAT(RefusalOf("time_s,x_mm,y_mm,z_mm\n0,1,2,3\n", InUnit(1)),
              StartsWith("take.csv:1: column \"x_mm\": the column is in mm, but the scene says"));
}

TEST(PointTable, RefusesAxesInDifferentUnits) {
  EXPECT_THAT(RefusalOf("time_s,x_mm,y_cm,z_mm\n0,1,2,3\n"), HasSubstr("different units"));
}

TEST(PointTable, RefusesAMissingAxis) {
  EXPECT_THAT(RefusalOf("time_s,x_mm,z_mm\n0,1,2\n"),
              StartsWith("take.csv:1: got no column for y of the points"));
}

TEST(PointTable, RefusesAnUnknownColumn) {
  EXPECT_THAT(RefusalOf("time_s,x_mm,y_mm,z_mm,colour\n0,1,2,3,red\n"),
              StartsWith("take.csv:1: column \"colour\": unknown column"));
}

TEST(PointTable, RefusesALabelThatIsNoMarker) {
  EXPECT_THAT(
      RefusalOf("time_s,marker,x_mm,y_mm,z_mm\n0,tip,1,2,3\n0,8,1,2,3\n"),
      StartsWith("take.csv:3: column \"marker\": got a point called \"8\", expected tip, 7"));
}

TEST(PointTable, RefusesAPointThatIsThereTwice) {
  EXPECT_EQ(RefusalOf("time_s,marker,x_mm,y_mm,z_mm\n0.5,tip,1,2,3\n0.5,tip,1,2,3\n"),
            "take.csv:3: got the point \"tip\" twice at 0.5 s, expected once");
}

TEST(PointTable, RefusesTimesThatDoNotAscend) {
  EXPECT_EQ(RefusalOf("time_s,x_mm,y_mm,z_mm\n0.5,1,2,3\n0.25,1,2,3\n"),
            "take.csv:3: got the time 0.25 s after 0.5 s, expected ascending times");
}

TEST(PointTable, RefusesFramesWithoutTimes) {
  EXPECT_THAT(RefusalOf("frame,x_mm,y_mm,z_mm\n0,1,2,3\n"),
              StartsWith("take.csv:1: got frames without times"));
  EXPECT_THAT(RefusalOf("x_mm,y_mm,z_mm\n1,2,3\n"), HasSubstr("expected also \"time_s\""));
}

TEST(PointTable, RefusesARowThatWasCutShort) {
  EXPECT_THAT(RefusalOf("time_s,x_mm,y_mm,z_mm\n0,1,2,3\n0.1,1\n"),
              StartsWith("take.csv:3: got 2 cells, expected 4 as in the header"));
}

TEST(PointTable, RefusesWhatIsNoNumber) {
  EXPECT_THAT(RefusalOf("time_s,x_mm,y_mm,z_mm\n0,1,two,3\n"),
              StartsWith("take.csv:2: column \"y"));
}

TEST(PointTable, RefusesAnEmptyFile) {
  EXPECT_THAT(RefusalOf(""), StartsWith("take.csv: got no points"));
  EXPECT_THAT(RefusalOf("time_s,x_mm,y_mm,z_mm\n"), StartsWith("take.csv: got no points"));
}

}  // namespace
}  // namespace softforce::scene
