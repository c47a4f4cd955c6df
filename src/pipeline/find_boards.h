#pragma once

#include <vector>

#include "softforce/pipeline/calibrate.h"

namespace softforce::pipeline {

// The board in the pictures that all cameras took at one moment, looked for side by side.
std::vector<vision::BoardDetection> DetectBoards(const CalibrateOptions& options,
                                                 const std::vector<cv::Mat>& pictures);

// What the pictures of all cameras show of the board: `input` and `left_out` of the record are
// filled. Throws InputError as Calibrate() does.
void FindBoards(const CalibrateOptions& options, report::CalibrationRecord& record);

}  // namespace softforce::pipeline
