#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/vision/board.h"

namespace softforce::vision {

// The points of a board that one picture shows; three arrays of equal length, by rising id.
struct BoardView {
  std::vector<int> ids;                 // Board::Point(id) is the place on the board
  std::vector<Eigen::Vector2d> pixels;  // px; pixel (0, 0) is the CENTRE of the top left pixel
  // px², from the picture's noise and the sharpness of its edges. What JPEG, optics and print add,
  // 0.01 px and more, is not in them.
  std::vector<Eigen::Matrix2d> covariances;

  int size() const { return static_cast<int>(ids.size()); }
};

struct BoardOptions {
  int min_points = 6;         // fewer make no detection
  double max_window = 0.7;    // half width of the window around a corner, in squares
  double max_window_px = 25;  // px, the same where that is less
  double min_contrast = 10;   // grey levels between dark and bright parts of the board
  double border = 4;          // px; points closer to the picture's edge are left out

  void Check() const;  // throws InputError naming the option
};

struct BoardDetection {
  enum class Status { kNotRun, kOk, kNotFound, kTooFewPoints };

  Status status = Status::kNotRun;
  BoardView view;      // filled only if ok()
  double cell = NAN;   // px, median picture of Board::CellSize()
  double blur = NAN;   // px, standard deviation of the blur of the board's edges, median
  std::string reason;  // why not, for a person; empty if ok()

  bool ok() const { return status == Status::kOk; }
};

// Finds a board in an 8-bit grey picture. OpenCV's detectors (chessboards, ArUco) or libapriltag
// say roughly where its points are; each point is then measured at full resolution in a window
// that follows the local size of the squares. Every pixel given is the picture of the board's
// point itself: half-pixel conventions of the libraries and the difference between a slanted
// circle's centroid and the picture of its centre are taken off here.
//
// Chessboards and circles are found as a whole or not at all; ChArUco and AprilGrid may be partly
// outside the picture or covered. A board that is not there is an answer: read `status`.
BoardDetection DetectBoard(const cv::Mat& grey, const Board& board,
                           const BoardOptions& options = {});

}  // namespace softforce::vision
