#include "softforce/report/run_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softforce::report {
namespace {

RunColumn Frame(int number, double norm, unsigned char marker) {
  RunColumn column;
  column.first_frame = column.last_frame = number;
  column.first_s = column.last_s = number / 30.0;
  column.frames = 1;
  column.forces.resize(1);
  column.forces[0].value[3].Add(norm);
  column.forces[0].band[3].Add(norm - 0.1);
  column.forces[0].band[3].Add(norm + 0.1);
  column.markers = {marker};
  return column;
}

Extent NormOf(const RunColumns& columns) {
  Extent all;
  for (const RunColumn& column : columns.columns()) all.Add(column.forces[0].value[3]);
  return all;
}

TEST(Extent, IsUnknownUntilAValueIsFinite) {
  Extent extent;
  extent.Add(NAN);
  extent.Add(Extent());
  EXPECT_FALSE(extent.known());
  extent.Add(-2);
  EXPECT_TRUE(extent.known());
  EXPECT_EQ(extent.low, -2);
  EXPECT_EQ(extent.high, -2);
}

TEST(RunColumns, HoldEveryFrameOfAShortRunByItself) {
  RunColumns columns;
  for (int i = 0; i < RunColumns::kMaxColumns; ++i) columns.Add(Frame(i, i, 0));
  ASSERT_EQ(columns.columns().size(), static_cast<size_t>(RunColumns::kMaxColumns));
  EXPECT_EQ(columns.frames_per_column(), 1);
  EXPECT_EQ(columns.columns()[7].first_frame, 7);
}

TEST(RunColumns, AreNeverMoreThanTheirBound) {
  RunColumns columns;
  for (int i = 0; i < 100000; ++i) {
    columns.Add(Frame(i, 1, 0));
    ASSERT_LE(columns.columns().size(), static_cast<size_t>(RunColumns::kMaxColumns));
  }
  int frames = 0;
  for (size_t i = 0; i < columns.columns().size(); ++i) {
    const RunColumn& column = columns.columns()[i];
    frames += column.frames;
    EXPECT_EQ(column.first_frame, i == 0 ? 0 : columns.columns()[i - 1].last_frame + 1);
  }
  EXPECT_EQ(frames, 100000);
  EXPECT_GT(columns.columns().size(), static_cast<size_t>(RunColumns::kMaxColumns / 2));
}

TEST(RunColumns, KeepTheExtremesOfSingleFrames) {
  RunColumns columns;
  for (int i = 0; i < 100000; ++i) {
    const double norm = i == 12345 ? 9.0 : i == 54321 ? -3.0 : 1.0;
    columns.Add(Frame(i, norm, i == 777 ? 3 : 0));
  }
  EXPECT_EQ(NormOf(columns).high, 9);
  EXPECT_EQ(NormOf(columns).low, -3);
  int grave = 0;
  for (const RunColumn& column : columns.columns()) {
    const bool has_777 = column.first_frame <= 777 && 777 <= column.last_frame;
    EXPECT_EQ(column.markers[0], has_777 ? 3 : 0);
    grave += column.markers[0] == 3;
  }
  EXPECT_EQ(grave, 1);
}

TEST(RunColumns, JoinAForceThatCameLater) {
  RunColumn early = Frame(0, 1, 0);
  RunColumn late = Frame(1, 2, 0);
  late.forces.resize(2);
  late.forces[1].value[0].Add(5);
  early.Add(late);
  ASSERT_EQ(early.forces.size(), 2u);
  EXPECT_EQ(early.forces[1].value[0].low, 5);
  EXPECT_EQ(early.last_frame, 1);
  EXPECT_EQ(early.frames, 2);
}

}  // namespace
}  // namespace softforce::report
