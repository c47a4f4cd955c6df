#include "pipeline/live_state.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softforce::pipeline {
namespace {

using nlohmann::json;

FrameResult FrameAt(double time_s) {
  FrameResult result;
  result.frame = 3;
  result.time_s = time_s;
  result.status = estimation::ForceEstimate::Status::kOk;
  ForceResult force;
  force.identity = 2;
  force.force = {0, 3, 4};
  force.covariance = 0.25 * Eigen::Matrix3d::Identity();
  result.forces.push_back(force);
  MarkerResult marker;
  marker.id = 7;
  marker.status = MarkerStatus::kRejected;
  result.markers.push_back(marker);
  return result;
}

TEST(LiveState, TellsForcesWithTheirStandardDeviations) {
  const json state = json::parse(LiveStateJson(LiveFacts(), FrameAt(1.5), nullptr));

  EXPECT_EQ(state["frame"], 3);
  EXPECT_EQ(state["time"], 1.5);
  EXPECT_EQ(state["forces"][0], json({"F2", 0.0, 3.0, 4.0, 5.0, 0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(state["markers"][0], json({7, 3}));
  EXPECT_EQ(state["statuses"][3], "rejected");
}

TEST(LiveState, TellsWhyThereAreNoForces) {
  FrameResult frame = FrameAt(0);
  frame.status = estimation::ForceEstimate::Status::kNotRun;
  frame.reason = "too few markers";

  EXPECT_EQ(json::parse(LiveStateJson(LiveFacts(), frame, nullptr))["reason"], "too few markers");
}

TEST(LiveState, TellsWhatWasAskedAndWhatWasDone) {
  RunControls controls;
  controls.tares = 2;
  controls.tared = 1;
  controls.pause = true;

  const json state = json::parse(LiveStateJson(LiveFacts(), FrameAt(0), &controls));

  EXPECT_EQ(state["controls"]["tares"], 2);
  EXPECT_EQ(state["controls"]["tared"], 1);
  EXPECT_EQ(state["controls"]["paused"], true);
}

TEST(LiveState, IsJsonBeforeTheFirstFrameAndWithAnyName) {
  LiveFacts facts;
  facts.scene = "a\"b\xff</script>";

  const json state = json::parse(LiveStateJson(facts, FrameResult(), nullptr));

  EXPECT_EQ(state["frame"], -1);
  EXPECT_EQ(state["time"], 0);
}

TEST(LiveHistory, HoldsTheLastMinute) {
  LiveHistory history;
  for (int i = 0; i <= 100; ++i) history.Add(FrameAt(i));

  EXPECT_EQ(history.points().front().time_s, 40);
  EXPECT_EQ(history.points().back().time_s, 100);
}

TEST(LiveHistory, IsBoundedAndKeepsItsSpanAndTheNewest) {
  LiveHistory history;
  for (int i = 0; i < 20'000; ++i) history.Add(FrameAt(1e-3 * i));

  EXPECT_LE(history.points().size(), LiveHistory::kMost);
  EXPECT_LT(history.points().front().time_s, 0.1);  // s, of 20
  EXPECT_EQ(history.points().back().time_s, 1e-3 * 19'999);
}

TEST(LiveHistory, IsToldAsJson) {
  LiveHistory history;
  history.Add(FrameAt(0.25));
  FrameResult none = FrameAt(0.5);
  none.forces.clear();
  history.Add(none);

  const json points = json::parse(LiveHistoryJson(history.points()))["points"];

  EXPECT_EQ(points[0], json({0.25, {{"F2", 0, 3, 4, 5, 0.5, 0.5, 0.5, 0.5}}}));
  EXPECT_EQ(points[1], json({0.5, json::array()}));
}

}  // namespace
}  // namespace softforce::pipeline
