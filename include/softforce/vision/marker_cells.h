#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace softforce::vision {

// The cells of an ArUco marker with its black border of one cell, 0 or 255, upright. Throws
// InputError, naming `where`, for a dictionary that OpenCV does not have, or an id that the
// dictionary does not have.
cv::Mat1b DrawMarker(const std::string& dictionary, int id, const std::string& where = "marker");

}  // namespace softforce::vision
