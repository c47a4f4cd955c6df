#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "softforce/vision/dots.h"
#include "vision/ellipse.h"

namespace softforce::vision {

// Measures the disc that a blob may be the picture of. Nothing if it is cut by the picture's edge,
// is not one even ellipse on even ground, or is outside the options' bounds.
std::optional<Dot> MeasureDot(const cv::Mat& grey, const Ellipse& blob, const DotOptions& options);

}  // namespace softforce::vision
