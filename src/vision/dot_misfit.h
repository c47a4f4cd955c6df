#pragma once

#include "vision/dot_patch.h"

namespace softforce::vision {

// A sharp ellipse and the blur (px, standard deviation, with the pixel's own) that it is seen with.
struct BlurredEllipse {
  Ellipse ellipse;
  double blur;
};

// The share of a pixel that a blurred disc covers, `outside` px from its sharp contour.
double ExpectedCoverage(double outside, double blur);

// How the picture of a dot differs from that of a blurred ellipse.
struct Misfit {
  double
      area_share;  // of the ellipse, that the dot exceeds or leaves out, beyond what noise explains
  double roughness;  // mean squared misfit of an edge pixel, over the noise's variance
  double chance;     // standard deviation of that if there is nothing but noise
};

// `patch_centre` is the place (px) from which the patch's pixels are counted; `area` is the dot's,
// px².
Misfit MeasureMisfit(const Patch& patch, const Levels& levels, const Eigen::Vector2d& patch_centre,
                     const BlurredEllipse& disc, double area);

}  // namespace softforce::vision
