#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace softforce::mesh {

// Points among which those that all but coincide with another one are found quickly.
class PointGrid {
 public:
  // Points at most `same` apart are one place.
  explicit PointGrid(double same) : same_(same) {}

  // The number of a point added before that coincides with p, or -1.
  int Find(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(same_);
    const Cell low = CellOf(p - reach), high = CellOf(p + reach);
    Cell c;
    for (c[0] = low[0]; c[0] <= high[0]; ++c[0]) {
      for (c[1] = low[1]; c[1] <= high[1]; ++c[1]) {
        for (c[2] = low[2]; c[2] <= high[2]; ++c[2]) {
          const auto cell = cells_.find(c);
          if (cell == cells_.end()) continue;
          for (const int i : cell->second) {
            if ((points_[i] - p).norm() <= same_) return i;
          }
        }
      }
    }
    return -1;
  }

  // Numbers are counted from 0.
  int Add(const Eigen::Vector3d& p) {
    cells_[CellOf(p)].push_back(static_cast<int>(points_.size()));
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  using Cell = std::array<long, 3>;

  // Cells are large beside `same`, so that a point rarely has to be looked for in several.
  Cell CellOf(const Eigen::Vector3d& p) const {
    Cell cell{};
    for (int i = 0; i < 3; ++i) cell[i] = std::lround(std::floor(p(i) / (1000 * same_)));
    return cell;
  }

  double same_;
  std::map<Cell, std::vector<int>> cells_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace softforce::mesh
