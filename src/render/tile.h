#pragma once

#include <array>
#include <vector>

#include "render/facets.h"
#include "render/ray_table.h"

namespace softforce::render {

// Each pixel is looked at along rays × rays rays. Those of a row of cells are shifted against
// those of the next, so that no two share a column or a row of the picture: an edge along the
// pixels is seen as finely as any other.
inline float RayOffset(int cell, int other_cell, int rays) {  // px from the pixel's centre
  const auto count = static_cast<float>(rays);
  return (static_cast<float>(cell) + (static_cast<float>(other_cell) + 0.5f) / count) / count -
         0.5f;
}

// A part of the picture, in all its rays.
class Tile {
 public:
  // `area`: px. Facets' and rays' tables must outlive it.
  Tile(const cv::Rect& area, const RayTable& rays, const PictureWorld& world,
       const PictureOptions& options, const std::vector<Facet>& facets);

  // The nearest thing along each ray counts, in whatever order they come.
  void AddFacet(int facet);
  void AddRod(const Eigen::Vector3d& begin, const Eigen::Vector3d& end, double diameter,
              double grey);  // m, camera frame

  // Grey levels along all rays, so many rows and columns per pixel. Adds to `seen`, per sticker on
  // the body, how many rays of the pixels in `core` end in its disc or square.
  cv::Mat1f Shade(const cv::Rect& core, std::vector<int>* seen) const;

 private:
  struct Hit {
    float inverse_depth = 0;  // 1/m
    int facet = -1;           // −1: the ground, −2: a rod
    float a = 0, b = 0;       // barycentric in the picture, of corners 0 and 1; grey of a rod
  };

  Hit& At(int x, int y, int i, int j) {  // pixel, cell
    return hits_[((y - area_.y) * per_side_ + j) * stride_ + (x - area_.x) * per_side_ + i];
  }
  float Paint(const Hit& hit, int* sticker_seen) const;

  cv::Rect area_;
  int per_side_;  // rays of a pixel
  const RayTable& rays_;
  const PictureWorld& world_;
  const PictureOptions& options_;
  const std::vector<Facet>& facets_;
  int stride_;
  std::vector<Hit> hits_;
};

}  // namespace softforce::render
