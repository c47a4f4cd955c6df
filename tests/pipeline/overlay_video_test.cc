#include "pipeline/overlay_video.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "pipeline/frame_file.h"
#include "pipeline/viewer_painter.h"
#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

const std::string kScene =
    std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/scene.yaml";
constexpr int kWidth = 640;  // px

class OverlayVideoTest : public ::testing::Test {
 protected:
  // The sheet under a wave, with a force of unknown place and a hidden marker.
  FrameInWork MakeFrame() const {
    FrameInWork frame;
    frame.set.pictures.assign(2, cv::Mat(1024, 1280, CV_8UC1, cv::Scalar(90)));
    const Eigen::Matrix3Xd& X = world_.mesh().nodes;
    frame.u = Eigen::Matrix3Xd::Zero(3, X.cols());
    frame.u.row(2) = 0.011 * (31 * X.row(0).array()).sin();
    frame.largest_displacement = frame.u.colwise().norm().maxCoeff();
    frame.T_rig_robot = Eigen::Translation3d(-0.1, -0.1, 0.6) *
                        Eigen::AngleAxisd(M_PI, Eigen::Vector3d(1, 0.1, 0).normalized());
    FrameResult& result = frame.result;
    result.frame = 3;
    result.time_s = 0.1;
    result.status = estimation::ForceEstimate::Status::kOk;
    result.probability = 0.83;
    ForceResult force;
    force.identity = 0;
    force.position = force.rest = X.col(0);
    force.force = {0.1, 0.2, -1.0 / 3};
    force.covariance = 1e-3 * Eigen::Matrix3d::Identity();
    force.place_covariance = 1e-5 * Eigen::Matrix3d::Identity();
    result.forces = {force};
    MarkerResult marker;
    marker.id = 4;
    marker.model = X.col(1);
    marker.expected_covariance = 1e-6 * Eigen::Matrix3d::Identity();
    result.markers = {marker};
    return frame;
  }

  FrameInWork ThroughTheFile(const FrameInWork& frame, const std::string& name) const {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / name;
    FrameFileWriter writer(file, world_.mesh().num_nodes());
    writer.Add(frame);
    writer.Commit();
    FrameInWork read = *FrameFileReader(file, world_.mesh().num_nodes()).Next();
    read.set = frame.set;
    return read;
  }

  const scene::Scene scene_ = scene::LoadScene(kScene);
  const camera::Rig rig_ = scene::LoadRig(scene_.cameras.rig);
  const World world_ = BuildWorld(scene_);
};

TEST_F(OverlayVideoTest, DrawsTheSamePixelsFromWhatTheFileKeeps) {
  for (const char* layers : {"all", "stress,net,forces"}) {
    const OverlayLayers shown = ParseOverlayLayers(layers, "--draw");
    FrameInWork frame = MakeFrame(), read = ThroughTheFile(frame, "overlay_video_frames.bin");
    OverlayVideo of_run({}, scene_, world_, rig_, kWidth, shown);
    OverlayVideo of_render({}, scene_, world_, rig_, kWidth, shown);
    ForceHistory history;
    history.Add(frame.result);
    if (shown.stress) {
      of_run.AddStress(&frame);
      of_render.AddStress(&read);
    }

    const cv::Mat before = of_run.Draw(frame), again = of_render.Draw(read);
    of_run.DrawHistory(frame, history, before);
    of_render.DrawHistory(read, history, again);

    ASSERT_EQ(before.size(), again.size());
    EXPECT_EQ(cv::norm(before, again, cv::NORM_INF), 0) << layers;
  }
}

TEST_F(OverlayVideoTest, ViewersGetTheForcesOverTimeWhereTheRunDrawsNothing) {
  FrameInWork frame = MakeFrame();
  ViewerPainter painter(scene_, world_, rig_, kWidth, {});
  painter.Note(frame.result);
  const cv::Mat first = painter.Draw(frame).clone();
  frame.result.time_s = 0.9;
  frame.result.forces[0].force *= 2;
  painter.Note(frame.result);

  const cv::Mat second = painter.Draw(frame);

  ASSERT_EQ(second.cols, kWidth);
  const int pictures = kWidth / 2 * 1024 / 1280;  // px, their height
  ASSERT_EQ(second.rows, pictures + ForceHistory::StripHeight(pictures));
  const auto orange = [&](const cv::Mat& drawn) {
    cv::Mat1b pixels;
    cv::inRange(drawn.rowRange(pictures, drawn.rows), cv::Scalar(0, 90, 130),
                cv::Scalar(40, 170, 240), pixels);  // blue green red, and its antialiased shades
    return cv::boundingRect(pixels.colRange(0, 3 * kWidth / 5)).width;
  };
  EXPECT_GT(orange(second), orange(first) + 100) << "px, a line from 0.1 s to 0.9 s";
}

TEST_F(OverlayVideoTest, LeavesOutTheStripWhereItIsNotAskedFor) {
  OverlayVideo bare({}, scene_, world_, rig_, kWidth, ParseOverlayLayers("net", "--draw"));
  const cv::Mat drawn = bare.Draw(MakeFrame());
  bare.DrawHistory(MakeFrame(), {}, drawn);
  EXPECT_EQ(drawn.size(), cv::Size(kWidth, kWidth / 2 * 1024 / 1280));
}

}  // namespace
}  // namespace softforce::pipeline
