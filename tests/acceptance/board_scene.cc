#include "acceptance/board_scene.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace softforce::testing {

cv::Mat BoardScene::Picture(const cv::Vec3d& turn, const cv::Vec3d& middle, bool right) const {
  cv::Matx33d R;
  cv::Rodrigues(turn, R);
  // A pixel of the print, then metres from its middle, then the camera's frame, then its pixels.
  const cv::Matx33d print_to_board(
      1 / pixels_per_metre, 0, -0.5 * (print.cols - 1) / pixels_per_metre, 0, 1 / pixels_per_metre,
      -0.5 * (print.rows - 1) / pixels_per_metre, 0, 0, 1);
  const cv::Matx33d board_to_camera(R(0, 0), R(0, 1), middle[0] - (right ? kBaseline : 0),  //
                                    R(1, 0), R(1, 1), middle[1],                            //
                                    R(2, 0), R(2, 1), middle[2]);
  // Drawn four times too large and averaged, as a camera's pixels do.
  const double f = 4 * kFocal;
  const cv::Matx33d K(f, 0, 4 * 320 - 0.5, 0, f, 4 * 240 - 0.5, 0, 0, 1);
  cv::Mat large, picture;
  cv::warpPerspective(print, large, K * board_to_camera * print_to_board, {4 * 640, 4 * 480},
                      cv::INTER_LINEAR, cv::BORDER_CONSTANT, 200);
  cv::resize(large, picture, {640, 480}, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(picture, picture, {}, 0.5);
  return picture;
}

BoardScene MakeChessboard(int columns, int rows) {
  const int square = 80;  // px of the print
  BoardScene scene;
  scene.pixels_per_metre = square / 0.02;
  scene.print.create(square * (rows + 3), square * (columns + 3), CV_8UC1);
  scene.print = 220;  // one square of margin
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      if ((i + j) % 2 == 1) continue;
      scene.print(cv::Rect((j + 1) * square, (i + 1) * square, square, square)) = 30;
    }
  }
  return scene;
}

std::vector<BoardPlace> GoodPlaces() {
  return {{{0.5, 0.1, 0.05}, {0.05, 0, 0.45}},     {{-0.5, 0.1, 0.1}, {0.08, 0.05, 0.5}},
          {{0.1, 0.5, 0}, {0.02, -0.05, 0.48}},    {{0, -0.5, -0.1}, {0.06, 0.04, 0.42}},
          {{0.4, 0.4, 0.2}, {0.10, -0.04, 0.55}},  {{-0.4, 0.4, -0.2}, {0, 0.06, 0.52}},
          {{0.35, -0.45, 0}, {0.03, -0.06, 0.46}}, {{-0.3, -0.4, 0.3}, {0.09, 0.02, 0.6}},
          {{0.05, 0, 1.0}, {0.05, 0, 0.5}},        {{0.1, 0.05, -0.6}, {0.04, 0.01, 0.36}}};
}

void WritePictures(const BoardScene& scene, const std::vector<BoardPlace>& places,
                   const std::filesystem::path& folder) {
  for (size_t i = 0; i < places.size(); ++i) {
    for (const bool right : {false, true}) {
      const std::string name = fmt::format("{}{:02}.png", right ? "right" : "left", i);
      cv::imwrite((folder / name).string(), scene.Picture(places[i].turn, places[i].middle, right));
    }
  }
}

}  // namespace softforce::testing
