#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vision/ellipse.h"
#include "vision/grey_plane.h"

namespace softforce::vision {

// The pixels around a blob, split by where they lie against its contour.
struct Patch {
  Patch() = default;
  Patch(Patch&&) = default;  // no copies: the lists point into `pixels`

  std::vector<PatchPixel> pixels;
  std::vector<const PatchPixel*> face, edge, ground;
  int inside = 0;  // pixels that the disc covers wholly
  Eigen::Vector2d inside_sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d inside_square = Eigen::Matrix2d::Zero();
};

// Grey levels of the dot and of the ground that it lies on.
struct Levels {
  GreyPlane ground;
  GreyPlane face;  // if not `own_slope`, the face less the ground, a constant
  bool own_slope;

  double Contrast(const Eigen::Vector2d& d) const {
    return own_slope ? face.At(d) - ground.At(d) : face.coefficients(2);
  }
  // The share of a pixel that the dot covers; noise takes it below 0 and above 1.
  double Coverage(const PatchPixel& pixel) const {
    return (pixel.value - ground.At(pixel.d)) / Contrast(pixel.d);
  }
  // Variance of a pixel's noise, grey levels².
  double Noise(double coverage) const;
};

// Everything within `margin` (px) of the contour is edge. Nothing if the picture ends too near.
std::optional<Patch> CutPatch(const cv::Mat& grey, const Ellipse& ellipse, double margin);

// Nothing unless both the dot and its ground are mostly even.
std::optional<Levels> FitLevels(const Patch& patch);

}  // namespace softforce::vision
