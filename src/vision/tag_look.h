#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

#include "softforce/vision/tag_cells.h"

namespace softforce::vision {

// The light of a flat tag as a blurred picture shows it, near its sides: what of a side's
// neighbourhood is owed to other edges, those of the code, of the other sides and of the paper.
class TagLook {
 public:
  // `corners` (px) of the square, as in Tag; `blur` in px, standard deviation. `around`: the light
  // that surrounds the tag's paper beyond each side (top, right, bottom, left): 0 like the square's
  // inner rim, 1 like what lies next to the square.
  TagLook(const TagCells& tag, bool reversed, const std::array<Eigen::Vector2d, 4>& corners,
          double blur, const std::array<double, 4>& around);

  // From 0, as inside of the square's rim, to 1, as next to the square.
  double LightAt(const Eigen::Vector2d& p) const;

 private:
  double Light(int column, int row) const;

  const TagCells& tag_;
  bool reversed_;
  double blur_;
  std::array<double, 4> around_;
  Eigen::Matrix3d cells_from_pixel_;
};

}  // namespace softforce::vision
