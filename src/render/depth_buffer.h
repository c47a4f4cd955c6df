#pragma once

#include <opencv2/core.hpp>

#include "render/view.h"

namespace softforce::render {

// How far the nearest surface is at every pixel. It keeps inverse depths, because these are linear
// in the picture over a flat face.
class DepthBuffer {
 public:
  // Before the first triangle of a picture.
  void Clear(cv::Size size);

  // `name` is what Nearest() calls the triangle, ≥ 0.
  void AddTriangle(const Sight& a, const Sight& b, const Sight& c, int name);

  static constexpr int kNothing = -1;

  // The name of the nearest triangle at each pixel, or kNothing, which it is outside Reach().
  const cv::Mat1i& Nearest() const { return nearest_; }
  const cv::Rect& Reach() const { return reach_; }

  // Whether a surface stands before the point. A point on a surface, or within a pixel of the
  // outline of the surface before it, is not hidden.
  bool Hides(const cv::Point2d& pixel, double inverse_depth) const;

 private:
  cv::Mat1f inverse_depth_;  // 1/m; 0 where there is no surface
  cv::Mat1i nearest_;
  cv::Rect reach_;  // all triangles lie within
};

}  // namespace softforce::render
