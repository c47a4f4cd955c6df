#pragma once

#include <Eigen/Geometry>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "render/view.h"
#include "softforce/render/picture.h"

namespace softforce::render {

// A flat triangle before the camera, and what is painted on it.
struct Facet {
  std::array<Eigen::Vector3d, 3> X;  // m, where its corners are at rest
  std::array<Eigen::Vector3d, 3> p;  // m, where they are now, camera frame
  std::array<float, 3> light;        // share of full light that falls on them
  const std::vector<int>* stickers;  // that may reach into it
  int card = -1;                     // that it is a part of; −1: the body
  cv::Rect reach;                    // px, it lies within
};

// Makes facets of the body's curved triangles and of the cards.
class FacetMaker {
 public:
  // World and view must outlive it.
  FacetMaker(const PictureWorld& world, const View& view, const PictureOptions& options);

  // Those that face the camera, with the nodes at `x`.
  std::vector<Facet> Make(const Eigen::Matrix3Xd& x) const;

 private:
  int CutsFor(const Eigen::Matrix3Xd& x) const;
  void AddTriangle(int triangle, const Eigen::Matrix3Xd& x, int cuts,
                   std::vector<Facet>* facets) const;
  void AddCard(int card, std::vector<Facet>* facets) const;
  float LightOn(const Eigen::Vector3d& normal_robot) const;
  bool Place(Facet* facet) const;  // sets `reach`; whether it is in sight

  const PictureWorld& world_;
  const View& view_;
  const PictureOptions& options_;
  std::vector<std::vector<int>> stickers_;  // of each triangle
  std::vector<std::vector<int>> no_stickers_;
};

}  // namespace softforce::render
