#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "softforce/vision/board.h"
#include "vision/local_map.h"
#include "vision/saddle_fit.h"

namespace softforce::vision {

// Where a board roughly is: places on it, not necessarily its own points, seen to about a pixel.
struct BoardStart {
  BoardSightings sightings;
  // Whether the field at the top left of the board is black; known beforehand for all boards but
  // some chessboards.
  bool top_left_black = true;
  std::string reason;  // why there are no sightings, for a person
};

// By OpenCV's detectors of chessboards. Ids are given as Board says, also where the pattern looks
// alike when turned.
BoardStart FindChessboard(const cv::Mat& grey, const Board& board);

// By OpenCV's ArUco markers; markers out of place with the others are left out.
BoardStart FindCharuco(const cv::Mat& grey, const Board& board);

// By libapriltag; tags out of place with the others are left out. Whichever way up the tags are
// printed on the grid, the same for all.
BoardStart FindAprilGrid(const cv::Mat& grey, const Board& board);

// What is printed around a board's point; not for circles.
CornerPrint PrintAround(const Board& board, int id, bool top_left_black);

// The homography that most of the sightings agree with to `tolerance` (px), and which do. Groups of
// `group` successive sightings stand or fall together.
std::vector<bool> InPlace(const BoardSightings& sightings, int group, double tolerance);

}  // namespace softforce::vision
