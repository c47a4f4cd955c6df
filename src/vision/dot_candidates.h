#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "softforce/vision/dots.h"
#include "vision/ellipse.h"

namespace softforce::vision {

// Blobs that are brighter (or darker) than their surroundings and roughly elliptic, to a pixel or
// so. Generous: what is returned still has to be looked at closely. Only those that lie in `rect`
// as a whole; they are the same as if the whole picture were looked at.
std::vector<Ellipse> FindEllipticBlobs(const cv::Mat& grey, const cv::Rect& rect,
                                       const DotOptions& options);

}  // namespace softforce::vision
