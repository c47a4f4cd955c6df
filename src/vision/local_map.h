#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace softforce::vision {

// Points of a flat board and where a picture shows them; a lens may bend it.
struct BoardSightings {
  std::vector<Eigen::Vector2d> places;  // m, on the board
  std::vector<Eigen::Vector2d> pixels;
};

// How the board is pictured near one of its places.
struct LocalMap {
  Eigen::Matrix3d pixel_from_offset;  // homography; offset from the place, m
  Eigen::Matrix3d offset_from_pixel;  // its inverse

  Eigen::Vector2d Pixel(const Eigen::Vector2d& offset) const;
  Eigen::Vector2d Offset(const Eigen::Vector2d& pixel) const;
  Eigen::Matrix2d Jacobian() const;  // px/m, at the place
};

// The homography through the sightings near `place`, nearer ones counting more: over a few squares
// a lens bends less than it does over the whole board. `range` (m): about how far "near" reaches.
// Nothing with fewer than four sightings, or if they lie on a line.
std::optional<LocalMap> FitLocalMap(const BoardSightings& sightings, const Eigen::Vector2d& place,
                                    double range);

}  // namespace softforce::vision
