#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/mesh/surface.h"

namespace softforce::render {

// A disc or a tag that sticks flat on a surface, or is a thing of its own.
struct Sticker {
  Eigen::Vector3d centre;     // m
  Eigen::Vector3d right, up;  // unit vectors along the surface, as one looks at the sticker
  double size = NAN;          // m: diameter of a disc; side of the square of a tag
  cv::Mat1b cells;            // of a tag seen upright, 0 or 255; empty: a disc
  int margin = 0;             // cells of the tag around that square

  Eigen::Vector3d normal() const { return right.cross(up); }
};

// A rod with round ends, which hides what is behind it; a ball if both ends are one place.
struct Rod {
  Eigen::Vector3d begin, end;  // m, robot frame
  double diameter = NAN;       // m
  double grey = 100;
};

// What stands before the cameras, at rest.
struct PictureWorld {
  const mesh::Surface* surface = nullptr;
  const Eigen::Matrix3Xd* X = nullptr;  // 3×N, m, nodes at rest
  std::vector<Sticker> stickers;        // on the surface, at rest; they deform with it
  std::vector<Sticker> cards;           // apart from the body, robot frame; they stay
};

struct PictureOptions {
  // The lens and the sensor.
  double blur = 0.7;   // px, standard deviation
  double noise = 1.7;  // grey levels, standard deviation
  // Along rows and columns, a square number per pixel. With 4, edges carry some 3 grey levels of
  // noise of their own.
  int rays = 4;
  double contrast = 1;    // grey levels are multiplied by it, then
  double brightness = 0;  // this is added
  // How much lighter the right edge is than the left, and the lower than the upper, as a share of
  // the middle.
  Eigen::Vector2d light_gradient = Eigen::Vector2d::Zero();
  // Paint and light.
  double ground = 70, body = 52, white = 215, black = 16;  // grey levels in full light
  double ambient = 0.4;  // share of the light that comes from everywhere
  Eigen::Vector3d light = Eigen::Vector3d::UnitZ();  // towards the lamp, robot frame

  void Check() const;  // throws InputError naming the option
};

struct Picture {
  cv::Mat grey;  // CV_8UC1
  // Of each sticker on the surface: how much of its disc or square is seen. 0 to 1.
  std::vector<double> visible_share;
};

// Takes pictures of a deforming body as one camera sees it. Every pixel is looked at along several
// rays, which are exact for the lens; the nearest surface counts. Curved triangles are cut into
// flat facets that are at most kFlatness off. What is on the surface is a matter of the place at
// rest, so that it stretches and foreshortens with the body. The same input gives the same picture.
class PictureMaker {
 public:
  static constexpr double kFlatness = 1e-5;  // m

  // The surface and the nodes at rest must outlive it. Throws InputError for options out of range.
  PictureMaker(const camera::Camera& camera, const Eigen::Isometry3d& T_camera_robot,
               const PictureWorld& world, const PictureOptions& options = {});
  ~PictureMaker();
  PictureMaker(PictureMaker&&) noexcept;

  // The body with its nodes at `x` (3×N, m, robot frame), behind and before `rods`. The noise is
  // another one for each seed.
  Picture Take(const Eigen::Matrix3Xd& x, const std::vector<Rod>& rods, std::uint32_t seed) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::render
