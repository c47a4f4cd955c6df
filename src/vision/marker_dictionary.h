#pragma once

#include <opencv2/aruco.hpp>
#include <string>

namespace softforce::vision {

// OpenCV's dictionary of ArUco markers, by its name without "DICT_", as "4X4_50". Throws
// InputError, naming `where`, for an unknown one.
cv::Ptr<cv::aruco::Dictionary> MarkerDictionary(const std::string& name, const std::string& where);

// How many markers it has.
int MarkersIn(const std::string& name, const std::string& where);

}  // namespace softforce::vision
