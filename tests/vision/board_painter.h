#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "softforce/vision/board.h"
#include "vision/synthetic_picture.h"

namespace softforce::testing {

struct PrintedBoard {
  vision::Board board;
  int black_border = 1;         // of AprilGrid's tags
  bool tags_upright = false;    // as OpenCV draws them; Kalibr's are turned by half a turn
  bool top_left_white = false;  // of a chessboard: as printed in negative
};

// Whether ink is at a place (m) of the board's frame. Written from the layouts' descriptions, not
// from the detector's tables.
bool HasInk(const PrintedBoard& printed, const Eigen::Vector2d& place);

// A board as a lens without distortion sees it.
struct BoardSight {
  Eigen::Matrix3d pixel_from_board;  // homography; m on the board to px

  Eigen::Vector2d Pixel(const Eigen::Vector3d& point) const;
};

// The middle of the board's points at `middle` (px), its x axis to the right and at `scale` px/m,
// then turned: `rotation` in the camera's frame (x right, y down, z forward). The camera's focal
// length is 1000 px; the larger `scale`, the stronger the perspective.
BoardSight LookAt(const vision::Board& board, const Eigen::Vector2d& middle, double scale,
                  const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

// Paints the board on white paper.
void PaintBoard(const PrintedBoard& printed, const BoardSight& sight, SyntheticScene* scene);

}  // namespace softforce::testing
