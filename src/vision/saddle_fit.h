#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "vision/local_map.h"

namespace softforce::vision {

// What is printed in one quadrant around a corner where four fields meet: one even field, so far.
struct Quadrant {
  double u, v;   // m, reach of the even field along the board's axes
  double strip;  // m; what is further than this from BOTH edges is something else (a marker)
};

// A corner where dark and bright fields meet like those of a chessboard.
struct CornerPrint {
  std::array<Quadrant, 4> quadrants;  // index (u > 0) + 2 (v > 0)
  double sign;  // 1: the quadrants u v > 0 are the bright ones; −1: they are the dark ones
};

struct SaddleFit {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d covariance;  // px²
  double blur;                 // px, standard deviation of the edges' blur
  double contrast;             // grey levels between the bright and the dark fields
  double misfit;               // grey levels, root mean square
};

struct SaddleOptions {
  double max_reach = 0;     // m, half width of the window
  double max_reach_px = 0;  // px, the same where that is less
  double min_contrast = 0;  // grey levels
};

// The place where two blurred edges cross, to a small part of a pixel: grey levels in the window
// are fitted, by Levenberg–Marquardt, with
//   (1 + light · (p − corner)) (mean + amplitude · erf(s₁ / √2 blur) · erf(s₂ / √2 blur)),
// s₁, s₂ the distances from the two edges. Perspective keeps edges straight, so the window may be
// as wide as the fields are; `map` tells which pixels see even fields, and where to start. Nothing
// if no such corner is there.
std::optional<SaddleFit> FitSaddle(const cv::Mat& grey, const LocalMap& map,
                                   const CornerPrint& print, const SaddleOptions& options);

}  // namespace softforce::vision
