#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>

#include "vision/step_fit.h"

namespace softforce::vision {

// Where to look for one straight edge.
struct EdgeSearch {
  Eigen::Vector2d from, to;  // px, its ends, known to about a pixel
  Eigen::Vector2d outward;   // unit, across it, to the side that is brighter if `rise` is positive
  double reach;              // px on either side; free of other edges
  double end_margin;         // px at either end that the neighbouring edge disturbs
  double rise;               // 1 or −1
  // How far the lens bends the line from `from` to `to` outward, px; t from 0 at `from` to 1.
  std::function<double(double t)> bend = nullptr;
  // Grey levels that other edges add at a pixel; nothing: none.
  std::function<double(const Eigen::Vector2d& p)> stray = nullptr;
  BlurPrior blur;
};

// An edge as offset(u) = a + b·u across it, at u along it, once the lens's bend is taken off.
struct Edge {
  Eigen::Vector2d middle, along, outward;  // px; unit vectors
  Eigen::Vector2d coefficients;            // a (px), b
  Eigen::Matrix2d covariance;  // of the coefficients, for noise that is independent in each pixel
  // How many times larger the covariance is because noise is alike in neighbouring pixels, as
  // estimated from this edge alone: rough; take the mean over several edges.
  double clustering;
  int pieces;                      // from so many pieces of the edge
  double roughness, rough_pixels;  // see FittedStep
  double inside, outside;          // grey levels on either side
  double blur;                     // px
  double noise;                    // grey levels, standard deviation of a pixel about the fit

  double OffsetVariance(const Eigen::Vector2d& p) const;  // px², of the edge's place near p
};

// Fits a blurred step to all pixels of the band around an edge: two grey levels, the blur, and the
// edge's place and tilt, by Gauss–Newton. No pixel is interpolated, so no phase of the pixel grid
// is favoured. Nothing if there is no such step, or too much of the band is something else.
std::optional<Edge> FitEdge(const cv::Mat& grey, const EdgeSearch& search);

}  // namespace softforce::vision
