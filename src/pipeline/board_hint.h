#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/vision/board.h"

namespace softforce::pipeline {

// Looks for boards other than the one that was told, in a few pictures in which that one was not
// found. What is seen instead and what to do, or a general advice if nothing is recognised.
std::string HintAtOtherBoard(const vision::Board& board, const std::vector<cv::Mat>& pictures);

// Throws InputError if tags or markers are seen that the board has not: the board is described
// wrongly. `where`: the picture's name.
void RefuseIdsBeyondBoard(const vision::Board& board, const cv::Mat& picture,
                          const std::string& where);

}  // namespace softforce::pipeline
