#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace softforce::vision {

enum class DotPolarity { kBright, kDark, kBoth };

struct DotOptions {
  DotPolarity polarity = DotPolarity::kBoth;
  double min_diameter = 4;      // px, of the short axis
  double max_diameter = 80;     // px, of the long axis
  double min_axis_ratio = 0.2;  // short axis over long axis; 0.2 is a disc seen at 78°
  double min_contrast = 15;     // grey levels between the dot and its surroundings
  double max_ellipse_misfit =
      0.06;  // share of the ellipse's area that the blob does not fill or exceeds

  void Check() const;  // throws InputError naming the option
};

// The picture of a disc.
struct Dot {
  // Centroid of the picture of the disc (px). It is NOT the projection of the disc's centre:
  // compare with camera::ProjectDiscCentroid.
  Eigen::Vector2d centroid = Eigen::Vector2d::Constant(NAN);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(NAN);  // px², from the picture's own noise
  double long_axis = NAN, short_axis = NAN;                     // px, full lengths
  double contrast = NAN;  // grey levels; positive: brighter than around
};

// Finds discs in an 8-bit grey picture: bright or dark ellipses on a locally even ground, of any
// slant and under uneven light. The centroid weighs each pixel by how much of it the disc covers,
// so it is sub-pixel and free of the threshold's bias. Ordered by row, then column: the same
// picture gives the same list. Clutter that looks like a disc is returned too.
std::vector<Dot> DetectDots(const cv::Mat& grey, const DotOptions& options = {});

// The same discs, but only those whose picture lies in one of the areas (px) as a whole: each once,
// measured as in the whole picture. Nothing is copied.
std::vector<Dot> DetectDotsIn(const cv::Mat& grey, const std::vector<cv::Rect>& areas,
                              const DotOptions& options = {});

}  // namespace softforce::vision
