#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "softforce/render/picture.h"

namespace softforce::simulation {

// A ball or a rod that passes before the cameras, or behind the body.
struct Occluder {
  double from_s = 0, until_s = std::numeric_limits<double>::infinity();
  Eigen::Vector3d begin = Eigen::Vector3d::Zero();  // m, robot frame; its place at `from_s`
  Eigen::Vector3d end = Eigen::Vector3d::Zero();    // at `until_s`; it moves evenly
  Eigen::Vector3d reach =
      Eigen::Vector3d::Zero();  // m, from one end of a rod to the other; 0: ball
  double diameter = NAN;        // m
  double grey = 100;            // grey level

  // Where it is at a time; nothing before and after its time.
  std::optional<render::Rod> At(double time_s) const;
};

// A disc on the surface at rest, at the place that is nearest.
render::Sticker DiscAt(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                       const Eigen::Vector3d& place, double diameter);

// A sticker at that place: `up` is the direction in the surface that is nearest to the one given.
render::Sticker StickerAt(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                          const Eigen::Vector3d& place, double size, const Eigen::Vector3d& up);

// Discs that belong to no marker, strewn evenly over those parts of the surface that face `facing`,
// each at least 1.5 diameters from the others, and from `keep_clear`. Fewer than `count` where
// there is no room. The seed decides where.
std::vector<render::Sticker> StrewDecoys(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                                         int count, double diameter, const Eigen::Vector3d& facing,
                                         const std::vector<render::Sticker>& keep_clear,
                                         std::uint32_t seed);

}  // namespace softforce::simulation
