#include "render/sticker_area.h"

#include <algorithm>
#include <cmath>

namespace softforce::render {
namespace {

// Corners of a polygon around the origin, clockwise in a picture; sizes as shares of the sticker's.
std::vector<Eigen::Vector2d> Rim(bool disc) {
  std::vector<Eigen::Vector2d> rim;
  if (disc) {
    constexpr int kCorners = 16;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = -2 * M_PI * i / kCorners;
      rim.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle));
    }
    return rim;
  }
  for (const auto& [s, t] :
       {std::pair{-1, 1}, {0, 1}, {1, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}}) {
    rim.emplace_back(0.5 * s, 0.5 * t);
  }
  return rim;
}

}  // namespace

StickerArea::StickerArea(const Sticker& sticker, const PictureWorld& world) {
  const std::vector<Eigen::Vector2d> rim = Rim(sticker.cells.empty());
  for (const Eigen::Vector2d& at : rim) {
    const Eigen::Vector3d place =
        sticker.centre + sticker.size * (at.x() * sticker.right + at.y() * sticker.up);
    rim_.push_back(mesh::ShapeFunctions(
        *world.surface, mesh::ClosestSurfacePoint(*world.surface, *world.X, place).at));
  }
  const double corners = static_cast<double>(rim.size());
  of_polygon_ = sticker.cells.empty() ? M_PI / (0.5 * corners * std::sin(2 * M_PI / corners)) : 1;
}

double StickerArea::At(const View& view, const Eigen::Matrix3Xd& x) const {
  double twice_area = 0;
  std::optional<Eigen::Vector2d> first, last;
  const auto add = [&](const Eigen::Vector2d& p) {
    if (last) twice_area += last->x() * p.y() - last->y() * p.x();
    last = p;
  };
  for (const mesh::NodalWeights& corner : rim_) {
    const camera::Projection at =
        camera::Project(view.camera->lens, view.T_camera_robot * corner.Apply(x));
    if (!at.visible) return 0;
    if (!first) first = at.pixel;
    add(at.pixel);
  }
  add(*first);
  return std::max(0.0, 0.5 * twice_area * of_polygon_);
}

}  // namespace softforce::render
