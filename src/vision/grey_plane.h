#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace softforce::vision {

// One pixel, seen from the centre of a blob.
struct PatchPixel {
  Eigen::Vector2d d;  // px, from the blob's centre
  double value;       // grey levels, a whole number
  double outside;     // px, from the blob's contour; negative inside
};

// A grey level that changes linearly over the picture, as an evenly coloured surface under uneven
// light.
struct GreyPlane {
  Eigen::Vector3d coefficients;  // grey levels: coefficients · (d, 1)
  Eigen::Matrix3d covariance;    // of the coefficients, from the noise
  double noise2;                 // grey levels², variance of one pixel; at least that of rounding
  double inlier_share;           // of the pixels, those that the plane explains

  double At(const Eigen::Vector2d& d) const { return coefficients.dot(d.homogeneous()); }
};

// The plane through most of the pixels; those that stand out (a neighbour, an edge) are left out.
// Without `sloped`, a constant. Nothing if fewer than six pixels agree.
std::optional<GreyPlane> FitGreyPlane(const std::vector<const PatchPixel*>& pixels, bool sloped);

}  // namespace softforce::vision
