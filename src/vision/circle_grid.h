#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "softforce/vision/board_detector.h"

namespace softforce::vision {

// Asymmetric circles: dots measured by DetectDots, put in order by OpenCV, each moved from the
// centroid of its picture to the picture of its centre; and the blur of their edges (px). Empty,
// with the reason, if the grid is not in sight as a whole.
BoardView FindCircles(const cv::Mat& grey, const Board& board, double* blur, std::string* reason);

}  // namespace softforce::vision
