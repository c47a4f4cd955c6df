#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

namespace softforce::testing {

// Pictures of a printed board as a pair of cameras without distortion sees it: 640 × 480 px, focal
// length 700 px, principal point (319.5, 239.5), the right camera 100 mm to the right of the left.
struct BoardScene {
  static constexpr double kFocal = 700, kBaseline = 0.1;

  cv::Mat print;                // the board, seen straight, grey
  double pixels_per_metre = 0;  // of `print`

  // `turn`: rotation vector, rad; `middle`: of the print, m, in the left camera's frame.
  cv::Mat Picture(const cv::Vec3d& turn, const cv::Vec3d& middle, bool right) const;
};

// A chessboard of so many inner corners and squares of 20 mm.
BoardScene MakeChessboard(int columns, int rows);

struct BoardPlace {
  cv::Vec3d turn, middle;
};

// Ten places, tilted to all sides and spread over the pictures.
std::vector<BoardPlace> GoodPlaces();

// Writes left00.png, right00.png, … into the folder.
void WritePictures(const BoardScene& scene, const std::vector<BoardPlace>& places,
                   const std::filesystem::path& folder);

}  // namespace softforce::testing
