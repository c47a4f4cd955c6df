// Boards on the rendered pictures beside the project, whose truth is known: real lens distortion,
// uneven ground, JPEG.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "softforce/camera/rig.h"
#include "softforce/vision/board_detector.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;

const fs::path kPictures = fs::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings/calibration";

nlohmann::json ReadJson(const fs::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

using Lens = decltype(camera::Camera::lens);

Lens LensOf(const nlohmann::json& camera) {
  Lens lens;
  lens.fx = camera["K"][0][0];
  lens.fy = camera["K"][1][1];
  lens.cx = camera["K"][0][2];
  lens.cy = camera["K"][1][2];
  for (size_t k = 0; k < camera["D"].size(); ++k) lens.distortion[k] = camera["D"][k];
  return lens;
}

struct Series {
  const char* name;
  const char* board;
  // From the truth's frame (the lower left of the printed area, x right, y up) to the board's, m.
  Eigen::Vector2d origin;
  bool y_down;
  double max_rms;  // px per axis: the figure to beat for this kind of board
};

class RenderedBoards : public ::testing::TestWithParam<Series> {};

TEST_P(RenderedBoards, AreAllFoundAndMeasuredToTheTarget) {
  if (!fs::is_directory(kPictures)) GTEST_SKIP() << "no recordings beside the project";
  const Series& series = GetParam();
  const Board board = ParseBoard(series.board);
  const auto cameras = ReadJson(kPictures / "cameras_truth.json");
  const auto truth = ReadJson(kPictures / (std::string(series.name) + "_truth.json"));
  double square = 0;
  int pictures = 0, count = 0;
  for (const auto& pair : truth["pairs"]) {
    if (pair["pair"].get<int>() % 5 != 0) continue;  // every fifth will do
    for (const std::string side : {"left", "right"}) {
      char name[64];
      std::snprintf(name, sizeof name, "%s_%02d_%s.jpg", series.name, pair["pair"].get<int>(),
                    side.c_str());
      if (!fs::exists(kPictures / name)) continue;  // the truth lists more than was shipped
      ++pictures;
      const cv::Mat grey = cv::imread((kPictures / name).string(), cv::IMREAD_GRAYSCALE);
      const BoardDetection detection = DetectBoard(grey, board);
      ASSERT_TRUE(detection.ok()) << name << ": " << detection.reason;
      EXPECT_GT(detection.view.size(), 0.9 * board.NumPoints()) << name;
      const auto& T = pair["T_" + side + "_board"];
      for (int k = 0; k < detection.view.size(); ++k) {
        const Eigen::Vector3d point = board.Point(detection.view.ids[k]);
        const Eigen::Vector4d place(
            1e3 * (series.origin.x() + point.x()),
            1e3 * (series.origin.y() + (series.y_down ? -1 : 1) * point.y()), 0, 1);
        Eigen::Vector3d p_camera;
        for (int i = 0; i < 3; ++i) {
          p_camera(i) = 1e-3 * (T[i][0].get<double>() * place(0) +
                                T[i][1].get<double>() * place(1) + T[i][3].get<double>());
        }
        const Eigen::Vector2d pixel = camera::Project(LensOf(cameras[side]), p_camera).pixel;
        square += 0.5 * (detection.view.pixels[k] - pixel).squaredNorm();
        ++count;
      }
    }
  }
  ASSERT_GE(pictures, 6);
  const double rms = std::sqrt(square / count);
  RecordProperty("rms_px", std::to_string(rms));
  EXPECT_LT(rms, series.max_rms);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, RenderedBoards,
    ::testing::Values(
        Series{"chess", "chessboard:9x6,square=20mm", {0.04, 0.14}, true, 0.025},
        Series{"charuco",
               "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50",
               {0.01, 0.21},
               true,
               0.034},
        Series{"aprilgrid", "aprilgrid:6x6,tag=24mm,spacing=0.3", {0.0162, 0.0162}, false, 0.05}),
    [](const auto& series) { return series.param.name; });

}  // namespace
}  // namespace softforce::vision
