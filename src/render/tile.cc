#include "render/tile.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "render/sticker_paint.h"

namespace softforce::render {
namespace {

constexpr int kRod = -2;

// What is linear over a flat facet in the coordinates of the plane z = 1.
struct FacetPlane {
  // Rows: barycentric coordinates in the picture, and the inverse depth (1/m), of (x, y, 1).
  Eigen::Matrix<double, 4, 3> of_ray;

  explicit FacetPlane(const Facet& facet) {
    Eigen::Matrix3d corners;
    Eigen::RowVector3d inverse_depth;
    for (int i = 0; i < 3; ++i) {
      corners.col(i) = facet.p[i] / facet.p[i].z();
      inverse_depth(i) = 1 / facet.p[i].z();
    }
    of_ray.topRows<3>() = corners.inverse();
    of_ray.row(3) = inverse_depth * of_ray.topRows<3>();
  }
};

// The same within one pixel.
struct PixelPlane {
  Eigen::Vector4f middle, by_u, by_v;

  PixelPlane(const FacetPlane& plane, const Ray& ray)
      : middle((plane.of_ray * Eigen::Vector3d(ray.x, ray.y, 1)).cast<float>()),
        by_u((plane.of_ray.leftCols<2>() * Eigen::Vector2d(ray.x_u, ray.y_u)).cast<float>()),
        by_v((plane.of_ray.leftCols<2>() * Eigen::Vector2d(ray.x_v, ray.y_v)).cast<float>()) {}

  // Whether some ray of the pixel may meet the facet.
  bool Near() const {
    const Eigen::Vector3f half = 0.5f * (by_u.cwiseAbs() + by_v.cwiseAbs()).head<3>();
    return ((middle.head<3>() + half).array() >= -kRounding).all();
  }

  static constexpr float kRounding = 2e-5f;  // so that no ray slips between two facets
};

// Where the ray along `d` comes closest to the rod's axis: the depth there, if it meets the rod.
float RodDepth(const Eigen::Vector3f& d, const Eigen::Vector3f& begin, const Eigen::Vector3f& axis,
               float radius) {
  const float dd = d.squaredNorm(), aa = axis.squaredNorm(), da = d.dot(axis);
  const float db = d.dot(begin), ab = axis.dot(begin);
  const float denominator = dd * aa - da * da;
  float along = denominator > 1e-6f * dd * aa ? (db * da - ab * dd) / denominator : 0;
  along = std::clamp(along, 0.0f, 1.0f);
  const Eigen::Vector3f on_axis = begin + along * axis;
  const float depth = d.dot(on_axis) / dd;
  return (depth * d - on_axis).squaredNorm() <= radius * radius ? depth : 0;
}

}  // namespace

Tile::Tile(const cv::Rect& area, const RayTable& rays, const PictureWorld& world,
           const PictureOptions& options, const std::vector<Facet>& facets)
    : area_(area),
      per_side_(options.rays),
      rays_(rays),
      world_(world),
      options_(options),
      facets_(facets),
      stride_(area.width * per_side_),
      hits_(static_cast<size_t>(stride_) * area.height * per_side_) {}

void Tile::AddFacet(int number) {
  const Facet& facet = facets_[number];
  const cv::Rect reach = facet.reach & area_;
  const FacetPlane plane(facet);
  const Sticker* cut_out = facet.card >= 0 && world_.cards[facet.card].cells.empty()
                               ? &world_.cards[facet.card]
                               : nullptr;
  for (int y = reach.y; y < reach.br().y; ++y) {
    for (int x = reach.x; x < reach.br().x; ++x) {
      const Ray& ray = rays_.At(x, y);
      if (!ray.ok()) continue;
      const PixelPlane pixel(plane, ray);
      if (!pixel.Near()) continue;
      for (int j = 0; j < per_side_; ++j) {
        for (int i = 0; i < per_side_; ++i) {
          const Eigen::Vector4f at = pixel.middle + RayOffset(i, j, per_side_) * pixel.by_u +
                                     RayOffset(j, i, per_side_) * pixel.by_v;
          Hit& hit = At(x, y, i, j);
          if (at.head<3>().minCoeff() < -PixelPlane::kRounding || at(3) <= hit.inverse_depth) {
            continue;
          }
          const Hit candidate{at(3), number, at(0), at(1)};
          if (cut_out != nullptr && Paint(candidate, nullptr) < 0) continue;
          hit = candidate;
        }
      }
    }
  }
}

void Tile::AddRod(const Eigen::Vector3d& begin, const Eigen::Vector3d& end, double diameter,
                  double grey) {
  const Eigen::Vector3f from = begin.cast<float>(), axis = (end - begin).cast<float>();
  const auto radius = static_cast<float>(diameter / 2);
  for (int y = area_.y; y < area_.br().y; ++y) {
    for (int x = area_.x; x < area_.br().x; ++x) {
      const Ray& ray = rays_.At(x, y);
      if (!ray.ok()) continue;
      const float pixel_width = std::hypot(ray.x_u, ray.y_v) * (from + axis + from).norm();
      if (RodDepth({ray.x, ray.y, 1}, from, axis, radius + pixel_width) <= 0) continue;
      for (int j = 0; j < per_side_; ++j) {
        for (int i = 0; i < per_side_; ++i) {
          const float u = RayOffset(i, j, per_side_), v = RayOffset(j, i, per_side_);
          const Eigen::Vector3f d(ray.x + u * ray.x_u + v * ray.x_v,
                                  ray.y + u * ray.y_u + v * ray.y_v, 1);
          const float depth = RodDepth(d, from, axis, radius);
          Hit& hit = At(x, y, i, j);
          if (depth <= 0 || 1 / depth <= hit.inverse_depth) continue;
          hit = {1 / depth, kRod, static_cast<float>(grey), 0};
        }
      }
    }
  }
}

// Grey level; below 0 beyond the rim of a disc that is a card. `sticker_seen`: the sticker on the
// body that the ray ends in.
float Tile::Paint(const Hit& hit, int* sticker_seen) const {
  const Facet& facet = facets_[hit.facet];
  const float depth = 1 / hit.inverse_depth;
  const std::array<float, 3> in_picture{hit.a, hit.b, 1 - hit.a - hit.b};
  std::array<float, 3> share;  // barycentric on the facet itself
  float light = 0;
  for (int i = 0; i < 3; ++i) {
    share[i] = in_picture[i] / static_cast<float>(facet.p[i].z()) * depth;
    light += share[i] * facet.light[i];
  }
  if (facet.card < 0 && facet.stickers->empty()) {
    return static_cast<float>(options_.body) * light;
  }
  const Eigen::Vector3d X = share[0] * facet.X[0] + share[1] * facet.X[1] + share[2] * facet.X[2];
  const auto lit = [&](bool white) {
    return static_cast<float>(white ? options_.white : options_.black) * light;
  };
  if (facet.card >= 0) {
    const auto paint = PaintAt(world_.cards[facet.card], X);
    return paint ? lit(paint->white) : -1;
  }
  for (const int s : *facet.stickers) {
    const auto paint = PaintAt(world_.stickers[s], X);
    if (!paint) continue;
    if (paint->within) *sticker_seen = s;
    return lit(paint->white);
  }
  return static_cast<float>(options_.body) * light;
}

cv::Mat1f Tile::Shade(const cv::Rect& core, std::vector<int>* seen) const {
  cv::Mat1f grey(area_.height * per_side_, stride_);
  for (int row = 0; row < grey.rows; ++row) {
    const bool row_in_core =
        row / per_side_ + area_.y >= core.y && row / per_side_ + area_.y < core.br().y;
    float* out = grey[row];
    for (int column = 0; column < grey.cols; ++column) {
      const Hit& hit = hits_[static_cast<size_t>(row) * stride_ + column];
      if (hit.facet == -1) {
        out[column] = static_cast<float>(options_.ground);
      } else if (hit.facet == kRod) {
        out[column] = hit.a;
      } else {
        int sticker = -1;
        const float level = Paint(hit, &sticker);
        out[column] = level < 0 ? static_cast<float>(options_.white) : level;
        const int x = column / per_side_ + area_.x;
        if (sticker >= 0 && row_in_core && x >= core.x && x < core.br().x) ++(*seen)[sticker];
      }
    }
  }
  return grey;
}

}  // namespace softforce::render
