#include <fmt/format.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "vision/board_start.h"

namespace softforce::vision {
namespace {

// The corners in OpenCV's order: row by row, from a corner of its choice.
std::vector<cv::Point2f> OpenCvCorners(const cv::Mat& grey, const Board& board) {
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> corners;
  const int flags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  if (cv::findChessboardCorners(grey, size, corners, flags)) return corners;
  // Slower, and sees more: blurred, slanted and strongly distorted ones.
  if (cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) {
    return corners;
  }
  return {};
}

// One way to lay the board's columns and rows over the corners found.
struct Reading {
  std::vector<Eigen::Vector2d> pixels;  // by id
  bool top_left_black = true;
  double upright = 0;  // 1: the board's x axis points right in the picture
};

// Mean grey of the squares that share the top left square's colour, less that of the others.
double ColourDifference(const cv::Mat& grey, const Board& board,
                        const std::vector<Eigen::Vector2d>& pixels) {
  double difference = 0;
  for (int i = 0; i + 1 < board.rows; ++i) {
    for (int j = 0; j + 1 < board.columns; ++j) {
      const int id = i * board.columns + j;
      const Eigen::Vector2d centre =
          0.25 * (pixels[id] + pixels[id + 1] + pixels[id + board.columns] +
                  pixels[id + board.columns + 1]);
      const cv::Point at(cvRound(centre.x()), cvRound(centre.y()));
      if (!cv::Rect(0, 0, grey.cols, grey.rows).contains(at)) continue;
      // Square (i + 1, j + 1), counted from the top left one.
      difference += (i + j) % 2 == 0 ? grey.at<uchar>(at) : -grey.at<uchar>(at);
    }
  }
  return difference;
}

// Rejects mirrored ones: the board is seen from its front.
bool IsFromTheFront(const Board& board, const std::vector<Eigen::Vector2d>& pixels) {
  const Eigen::Vector2d along = pixels[board.columns - 1] - pixels[0];
  const Eigen::Vector2d down = pixels[(board.rows - 1) * board.columns] - pixels[0];
  return along.x() * down.y() - along.y() * down.x() > 0;
}

std::vector<Reading> Readings(const cv::Mat& grey, const Board& board,
                              const std::vector<cv::Point2f>& corners) {
  const int columns = board.columns, rows = board.rows;
  std::vector<Reading> readings;
  for (int turn = 0; turn < 8; ++turn) {
    const bool transpose = (turn & 4) != 0;
    if (transpose && columns != rows) continue;
    Reading reading;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        int row = (turn & 1) != 0 ? rows - 1 - i : i;
        int column = (turn & 2) != 0 ? columns - 1 - j : j;
        if (transpose) std::swap(row, column);
        const cv::Point2f& p = corners[row * columns + column];
        reading.pixels.emplace_back(p.x, p.y);
      }
    }
    if (!IsFromTheFront(board, reading.pixels)) continue;
    reading.top_left_black = ColourDifference(grey, board, reading.pixels) < 0;
    const Eigen::Vector2d along = reading.pixels[columns - 1] - reading.pixels[0];
    reading.upright = along.normalized().x();
    readings.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace

BoardStart FindChessboard(const cv::Mat& grey, const Board& board) {
  BoardStart start;
  const std::vector<cv::Point2f> corners = OpenCvCorners(grey, board);
  if (corners.empty()) {
    start.reason = fmt::format("no chessboard of {}x{} inner corners is in sight as a whole",
                               board.columns, board.rows);
    return start;
  }
  const std::vector<Reading> readings = Readings(grey, board, corners);
  if (readings.empty()) {
    start.reason = "the corners found form no grid seen from its front";
    return start;
  }
  // A black square at the top left decides where it can; else how upright the board stands.
  const Reading* best = nullptr;
  for (const Reading& reading : readings) {
    const bool better =
        best == nullptr || (reading.top_left_black && !best->top_left_black) ||
        (reading.top_left_black == best->top_left_black && reading.upright > best->upright);
    if (better) best = &reading;
  }
  start.sightings.pixels = best->pixels;
  start.top_left_black = best->top_left_black;
  for (const Eigen::Vector3d& point : board.Points()) {
    start.sightings.places.push_back(point.head<2>());
  }
  return start;
}

}  // namespace softforce::vision
