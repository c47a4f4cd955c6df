#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

const std::filesystem::path kFolder = SOFTFORCE_SOURCE_DIR "/../shared/recordings/calibration";

struct Series {
  const char* name;
  const char* board;
};

class OnRenderedBoards : public ::testing::TestWithParam<Series> {};

CalibrationInput Look(const Series& series) {
  const vision::Board board = vision::ParseBoard(series.board);
  CalibrationInput input;
  input.board = board.Points();
  for (const char* side : {"left", "right"}) {
    input.cameras.push_back({side, 1280, 1024, LensFit::kBrownConrady5});
  }
  for (int v = 0; v < 8; ++v) {
    CalibrationView view;
    view.name = std::to_string(v);
    for (const char* side : {"left", "right"}) {
      char number[3];
      std::snprintf(number, sizeof number, "%02d", v);
      const auto file = kFolder / (std::string(series.name) + "_" + number + "_" + side + ".jpg");
      const cv::Mat picture = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
      view.seen.push_back(vision::DetectBoard(picture, board).view);
    }
    input.views.push_back(view);
  }
  return input;
}

TEST_P(OnRenderedBoards, TheRigMeetsTheTruth) {
  std::ifstream file(kFolder / "cameras_truth.json");
  if (!file) GTEST_SKIP() << "no recordings beside the project";
  const nlohmann::json truth = nlohmann::json::parse(file);
  CalibrationOptions options;
  options.max_folds = 0;

  const Calibration result = Calibrate(Look(GetParam()), options);

  ASSERT_TRUE(result.ok()) << result.reason;
  for (const camera::Camera& camera : result.rig.cameras) {
    const double fx = truth[camera.name]["K"][0][0];
    const double fy = truth[camera.name]["K"][1][1];
    std::cout << "  " << camera.name << ": fx off by " << camera.lens.fx - fx << " px, fy by "
              << camera.lens.fy - fy << " px\n";
    EXPECT_NEAR(camera.lens.fx, fx, 1e-3 * fx);  // 0.1 %, required
    EXPECT_NEAR(camera.lens.fy, fy, 1e-3 * fy);
  }
  Eigen::Vector3d t_mm;
  for (int i = 0; i < 3; ++i) t_mm(i) = truth["stereo"]["t_mm"][i];
  const double baseline_mm = 1e3 * result.rig.cameras[1].T_camera_rig.translation().norm();
  std::cout << "  baseline off by " << baseline_mm - t_mm.norm() << " mm\n";
  EXPECT_NEAR(baseline_mm, t_mm.norm(), 0.1);  // mm, required
}

INSTANTIATE_TEST_SUITE_P(
    Shared, OnRenderedBoards,
    ::testing::Values(Series{"chess", "chessboard:9x6,square=20mm"},
                      Series{"charuco", "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50"},
                      Series{"aprilgrid", "aprilgrid:6x6,tag=24mm,spacing=0.3"}),
    [](const auto& series) { return series.param.name; });

}  // namespace
}  // namespace softforce::calibration
