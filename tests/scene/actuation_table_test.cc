#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

using testing::ActuationRefusal;
using ::testing::ElementsAre;
using testing::kActuationText;
using testing::kSceneText;
using testing::WriteScene;

// The inputs of the cable "left" (m), the cable "right" (N) and the chamber (Pa).
ActuationTable LoadTable(const std::string& text) {
  return LoadScene(WriteScene(kSceneText, text)).actuation;
}

TEST(ActuationTable, SortsTheColumnsLikeTheActuatorsAndConvertsThemToSi) {
  const ActuationTable table = LoadTable(kActuationText);

  EXPECT_THAT(table.time_s, ElementsAre(0, 0.5));
  EXPECT_TRUE(table.inputs.row(1).isApprox(Eigen::RowVector3d(8e-3, 1.5, 10e3)));
}

TEST(ActuationTable, IsLinearBetweenItsRows) {
  EXPECT_TRUE(LoadTable(kActuationText).At(0.125).isApprox(Eigen::Vector3d(2e-3, 0.375, 2.5e3)));
}

TEST(ActuationTable, IsHeldBeforeItsFirstRowAndAfterItsLast) {
  const ActuationTable table = LoadTable(kActuationText);

  EXPECT_EQ(table.At(-1), table.inputs.row(0).transpose());
  EXPECT_EQ(table.At(0.5), table.inputs.row(1).transpose());
  EXPECT_EQ(table.At(9), table.inputs.row(1).transpose());
}

TEST(ActuationTable, TakesWhatSpreadsheetsWrite) {
  const ActuationTable table =
      LoadTable("\xEF\xBB\xBFtime_s, left_mm, right_N, chamber_kPa\r\n0, 1, 2, 3\r\n\r\n");

  EXPECT_TRUE(table.At(0).isApprox(Eigen::Vector3d(1e-3, 2, 3e3)));
}

TEST(ActuationTable, RefusesAnUnknownColumn) {
  EXPECT_EQ(
      ActuationRefusal("time_s,left_N,right_N,chamber_kPa\n0,0,0,0\n"),
      "actuation.csv:1: column \"left_N\": unknown column, expected time_s, left_mm, right_N, "
      "chamber_kPa\n  Did you mean \"left_mm\"?");
}

TEST(ActuationTable, RefusesAMissingColumn) {
  EXPECT_EQ(
      ActuationRefusal("time_s,left_mm,right_N\n0,0,0\n"),
      "actuation.csv:1: got the columns time_s, left_mm, right_N; expected also \"chamber_kPa\"");
}

TEST(ActuationTable, RefusesAColumnGivenTwice) {
  EXPECT_EQ(ActuationRefusal("time_s,left_mm,left_mm,right_N,chamber_kPa\n0,0,0,0,0\n"),
            "actuation.csv:1: column \"left_mm\": the column is given twice, expected once");
}

TEST(ActuationTable, RefusesACellThatIsNoNumber) {
  EXPECT_EQ(ActuationRefusal("time_s,left_mm,right_N,chamber_kPa\n0,0,0,0\n1,0,x,0\n"),
            "actuation.csv:3: column \"right_N\": got \"x\", which does not start with a number; "
            "expected a number without unit\n  Write for example: 0.5");
}

TEST(ActuationTable, RefusesARowOfAnotherLength) {
  EXPECT_EQ(ActuationRefusal("time_s,left_mm,right_N,chamber_kPa\n0,0,0\n"),
            "actuation.csv:2: got 3 cells, expected 4 as in the header");
}

TEST(ActuationTable, RefusesATensionThatPushes) {
  EXPECT_EQ(ActuationRefusal("time_s,left_mm,right_N,chamber_kPa\n0,0,-1,0\n"),
            "actuation.csv:2: column \"right_N\": got a tension of -1 N, expected 0 or more: a "
            "cable cannot "
            "push");
}

TEST(ActuationTable, RefusesTimesThatDoNotAscend) {
  EXPECT_EQ(ActuationRefusal("time_s,left_mm,right_N,chamber_kPa\n0.5,0,0,0\n0.5,0,0,0\n"),
            "actuation.csv:3: got the time 0.5 s after 0.5 s, expected ascending times");
}

TEST(ActuationTable, RefusesATableWithoutRows) {
  EXPECT_EQ(ActuationRefusal("time_s,left_mm,right_N,chamber_kPa\n"),
            "actuation.csv: got no inputs, expected a header line and at least one row\n"
            "  The header is: time_s,left_mm,right_N,chamber_kPa");
}

}  // namespace
}  // namespace softforce::scene
