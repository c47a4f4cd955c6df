#pragma once

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

namespace softforce::render {

// A number that is linear over the picture.
struct Plane {
  double at_origin = 0, per_x = 0, per_y = 0;  // per_x, per_y: 1/px
  bool exists = false;                         // false: the corners lie on a line

  // That has the values at the corners (px) of a triangle.
  static Plane Through(const std::array<cv::Point2d, 3>& corners,
                       const std::array<double, 3>& values) {
    const cv::Point2d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const double area = ab.cross(ac);  // px², twice the triangle's
    if (std::abs(area) < 1e-9) return {};
    const double b = values[1] - values[0], c = values[2] - values[0];
    const double per_x = (b * ac.y - c * ab.y) / area;
    const double per_y = (c * ab.x - b * ac.x) / area;
    return {values[0] - per_x * corners[0].x - per_y * corners[0].y, per_x, per_y, true};
  }

  double At(double x, double y) const { return at_origin + per_x * x + per_y * y; }
};

}  // namespace softforce::render
