#include "render/ray_table.h"

#include <opencv2/core.hpp>

namespace softforce::render {

RayTable::RayTable(const camera::Camera& camera, int margin)
    : margin_(margin), stride_(camera.width + 2 * margin) {
  const int rows = camera.height + 2 * margin;
  rays_.resize(static_cast<size_t>(stride_) * rows);
  const auto look = [&](int column, int row) {
    const Eigen::Vector2d pixel(column - margin_, row - margin_);
    return camera::Unproject(camera.lens, pixel)
        .value_or(Eigen::Vector2d(Eigen::Vector2d::Constant(NAN)));
  };
  // A lens bends by far less than 1e-4 px from one pixel to the next, so that one-sided differences
  // tell how a ray turns within a pixel.
  cv::parallel_for_({0, rows}, [&](const cv::Range& range) {
    std::vector<Eigen::Vector2d> here(stride_ + 1), below(stride_ + 1);
    for (int row = range.start; row < range.end; ++row) {
      for (int column = 0; column <= stride_; ++column) {
        here[column] = row == range.start ? look(column, row) : below[column];
        below[column] = look(column, row + 1);
      }
      for (int column = 0; column < stride_; ++column) {
        const Eigen::Vector2f at = here[column].cast<float>();
        const Eigen::Vector2f by_u = (here[column + 1] - here[column]).cast<float>();
        const Eigen::Vector2f by_v = (below[column] - here[column]).cast<float>();
        const bool ok = at.allFinite() && by_u.allFinite() && by_v.allFinite();
        rays_[static_cast<size_t>(row) * stride_ + column] =
            ok ? Ray{at.x(), at.y(), by_u.x(), by_v.x(), by_u.y(), by_v.y()} : Ray{NAN, NAN};
      }
    }
  });
}

}  // namespace softforce::render
