#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/camera/rig.h"

namespace softforce::render {

// Where a pixel looks, on the plane z = 1 before the camera, and how that changes within it.
struct Ray {
  float x = 0, y = 0;
  float x_u = 0, x_v = 0, y_u = 0, y_v = 0;  // 1/px

  bool ok() const { return x == x; }  // false: the lens shows nothing there
};

// The rays of all pixels of a camera, and of a margin around the picture.
class RayTable {
 public:
  RayTable(const camera::Camera& camera, int margin);

  const Ray& At(int x, int y) const { return rays_[(y + margin_) * stride_ + x + margin_]; }

 private:
  int margin_, stride_;
  std::vector<Ray> rays_;
};

}  // namespace softforce::render
