#include "pipeline/report_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/run_advice.h"

namespace softforce::pipeline {
namespace {

using ::testing::HasSubstr;
using Status = estimation::ForceEstimate::Status;

const World& Sheet() {
  static const World kWorld = BuildWorld(scene::LoadScene(
      std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights/scene.yaml"));
  return kWorld;
}

FrameInWork Frame(int number, double norm, MarkerStatus marker = MarkerStatus::kSeen,
                  Status status = Status::kOk) {
  FrameInWork frame;
  frame.result.frame = number;
  frame.result.time_s = number / 30.0;
  frame.result.status = status;
  frame.result.chi2 = 10;
  frame.result.degrees_of_freedom = 20;
  if (status == Status::kOk) {
    ForceResult force;
    force.identity = 4;
    force.position = force.rest = Eigen::Vector3d::Zero();
    force.force = Eigen::Vector3d(0, 0, -norm);
    force.covariance = 1e-4 * Eigen::Matrix3d::Identity();  // N²
    frame.result.forces.push_back(force);
  }
  MarkerResult one;
  one.id = 7;
  one.status = marker;
  one.model = Eigen::Vector3d::Zero();
  frame.result.markers.push_back(one);
  frame.u = Eigen::Matrix3Xd::Constant(3, Sheet().mesh().num_nodes(), 1e-4 * number);
  frame.overlay = cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(number % 256));
  return frame;
}

report::RunRecord Filled(const ReportLog& log) {
  report::RunRecord record;
  log.Fill(&record);
  return record;
}

std::vector<std::string> Labels(const report::RunRecord& record) {
  std::vector<std::string> labels;
  for (const report::BodyView& view : record.views) {
    if (!view.label.empty()) labels.push_back(std::to_string(view.frame) + ": " + view.label);
  }
  return labels;
}

TEST(ReportLog, KeepsTheFramesThatMatter) {
  ReportLog log(Sheet());
  for (int i = 0; i < 9; ++i) {
    const bool lost = i == 3 || i == 4;
    log.Add(Frame(i, i == 6 ? 0.9 : 0.5, i == 5 ? MarkerStatus::kRejected : MarkerStatus::kSeen,
                  lost ? Status::kNotConverged : Status::kOk));
  }
  const report::RunRecord record = Filled(log);

  EXPECT_THAT(Labels(record), ::testing::ElementsAre("0: first frame", "3: first without forces",
                                                     "5: first with a rejected marker",
                                                     "6: largest force", "8: last frame"));
  EXPECT_EQ(record.views[static_cast<size_t>(record.first_view)].frame, 6);
  ASSERT_EQ(record.pictures.size(), 5u);
  EXPECT_THAT(record.pictures[3].caption, HasSubstr("Frame 6, 0.200 s: largest force"));
  EXPECT_EQ(record.pictures[3].jpeg.substr(0, 2), "\xff\xd8");
}

TEST(ReportLog, HasBandsThatHoldNinetyFivePercent) {
  ReportLog log(Sheet());
  log.Add(Frame(0, 0.5));
  const report::RunRecord record = Filled(log);

  ASSERT_THAT(record.forces, ::testing::ElementsAre("F4"));
  const report::ForceExtent& force = record.time.columns()[0].forces[0];
  EXPECT_DOUBLE_EQ(force.value[2].low, -0.5);
  // N; sd 0.01 N times the 97.5 % quantile of the normal distribution
  EXPECT_NEAR(force.band[2].high, -0.5 + 0.0195996, 1e-6);
  EXPECT_NEAR(force.band[3].low, 0.5 - 0.0195996, 1e-6);
}

TEST(ReportLog, KeepsABoundedNumberOfViewsEvenlySpread) {
  ReportLog log(Sheet());
  const int frames = 3000;
  for (int i = 0; i < frames; ++i) log.Add(Frame(i, i == 2001 ? 0.9 : 0.5));
  const report::RunRecord record = Filled(log);

  // The key frames come on top.
  EXPECT_LE(record.views.size(), static_cast<size_t>(ReportLog::kMaxViews + 5));
  const double bytes = 6.0 * static_cast<double>(record.body.nodes.cols() * record.views.size());
  EXPECT_LT(bytes, 1.2 * ReportLog::kViewBytes);
  int widest = 0;
  for (size_t i = 1; i < record.views.size(); ++i) {
    EXPECT_LT(record.views[i - 1].frame, record.views[i].frame);
    widest = std::max(widest, record.views[i].frame - record.views[i - 1].frame);
  }
  EXPECT_GT(record.views.size(), 15u);
  EXPECT_LE(widest, frames / 15);
  EXPECT_EQ(record.views[static_cast<size_t>(record.first_view)].frame, 2001);
}

TEST(ReportLog, ShowsTheWholeSurface) {
  const report::RunRecord record = Filled(ReportLog(Sheet()));
  EXPECT_EQ(record.body.triangles.cols(), 4 * Sheet().surface.num_triangles());  // order 2
  EXPECT_EQ(record.body.triangles.maxCoeff(), record.body.nodes.cols() - 1);
  EXPECT_EQ(record.body.triangles.minCoeff(), 0);
}

TEST(ReportLog, LeavesOutFramesWhoseBodyIsNotKnown) {
  ReportLog log(Sheet());
  FrameInWork frame = Frame(0, 0.5);
  frame.u.setConstant(NAN);
  log.Add(frame);
  const report::RunRecord record = Filled(log);
  EXPECT_TRUE(record.views.empty());
  EXPECT_EQ(record.time.columns().size(), 1u);
}

RunTally TallyOf(const std::vector<FrameInWork>& frames, ReportLog* log) {
  RunTally tally;
  for (const FrameInWork& frame : frames) {
    tally.Add(frame.result);
    log->Add(frame);
  }
  return tally;
}

TEST(AdviceFor, IsSilentAboutAGoodRun) {
  ReportLog log(Sheet());
  const RunTally tally = TallyOf({Frame(0, 0.5), Frame(1, 0.5)}, &log);
  EXPECT_TRUE(AdviceFor(tally, log).empty());
}

TEST(AdviceFor, NamesWhatIsWrongAndWhatToDo) {
  ReportLog log(Sheet());
  FrameInWork poor = Frame(0, 0.5, MarkerStatus::kRejected);
  poor.result.chi2 = 200;
  const RunTally tally =
      TallyOf({poor, poor, Frame(2, 0, MarkerStatus::kHidden, Status::kUnobservable)}, &log);

  const std::vector<report::RunAdvice> advice = AdviceFor(tally, log);
  ASSERT_EQ(advice.size(), 4u);
  EXPECT_THAT(advice[0].finding, HasSubstr("1 of 3 frames have no forces: unobservable"));
  EXPECT_THAT(advice[0].what_to_do, HasSubstr("fewer candidates"));
  EXPECT_THAT(advice[1].finding, HasSubstr("median χ² per degree of freedom 10.0"));
  EXPECT_THAT(advice[2].finding, HasSubstr("marker 7"));
  EXPECT_THAT(advice[3].finding, HasSubstr("33 % of the markers were hidden"));
}

}  // namespace
}  // namespace softforce::pipeline
