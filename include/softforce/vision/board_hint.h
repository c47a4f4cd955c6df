#pragma once

#include <string>

#include "softforce/vision/board_detector.h"

namespace softforce::vision {

// For a picture in which DetectBoard finds nothing: looks for boards that are easily taken for this
// one (squares counted for inner corners, columns for rows, the older ChArUco pattern, another
// dictionary or family) and says what is there instead, with the text to give; empty if nothing is.
// Slow: for one or two pictures, once the board was found in none.
std::string ExplainMissingBoard(const cv::Mat& grey, const Board& board);

}  // namespace softforce::vision
