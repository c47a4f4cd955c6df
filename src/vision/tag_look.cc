#include "vision/tag_look.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace softforce::vision {
namespace {

constexpr double kReach = 3.5;  // blurs, beyond which a cell leaves nothing

Eigen::Matrix3d CellsFromPixel(const TagCells& tag, const std::array<Eigen::Vector2d, 4>& corners) {
  const auto low = static_cast<float>(tag.margin);
  const auto high = static_cast<float>(tag.cells.cols - tag.margin);
  const std::array<cv::Point2f, 4> in_cells{{{low, low}, {high, low}, {high, high}, {low, high}}};
  // From a corner of the square: float coordinates would lose a thousandth of a pixel.
  std::array<cv::Point2f, 4> in_picture;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2f d = (corners[i] - corners[0]).cast<float>();
    in_picture[i] = {d.x(), d.y()};
  }
  const cv::Matx33d H = cv::getPerspectiveTransform(in_picture.data(), in_cells.data());
  Eigen::Matrix3d map, shift = Eigen::Matrix3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) map(r, c) = H(r, c);
  }
  shift.topRightCorner<2, 1>() = -corners[0];
  return map * shift;
}

// How much of each cell from `first` on a blurred point at x sees, along one direction.
struct Window {
  static constexpr int kMax = 24;
  int first = 0, count = 0;
  std::array<double, kMax> share{};

  Window(double x, double blur) {
    first = static_cast<int>(std::floor(x - kReach * blur));
    const int last = static_cast<int>(std::floor(x + kReach * blur));
    count = std::min(last - first + 1, kMax);
    double below = 0;
    for (int i = 0; i < count; ++i) {
      const double upper =
          i + 1 < count ? 0.5 * std::erfc((x - first - i - 1) / (blur * M_SQRT2)) : 1;
      share[i] = upper - below;
      below = upper;
    }
  }
};

}  // namespace

TagLook::TagLook(const TagCells& tag, bool reversed, const std::array<Eigen::Vector2d, 4>& corners,
                 double blur, const std::array<double, 4>& around)
    : tag_(tag),
      reversed_(reversed),
      blur_(blur),
      around_(around),
      cells_from_pixel_(CellsFromPixel(tag, corners)) {}

double TagLook::Light(int column, int row) const {
  const int last = tag_.cells.cols - 1;
  if (row < 0) return around_[0];
  if (column > last) return around_[1];
  if (row > last) return around_[2];
  if (column < 0) return around_[3];
  return (tag_.cells(row, column) > 0) != reversed_ ? 1 : 0;
}

double TagLook::LightAt(const Eigen::Vector2d& p) const {
  const Eigen::Vector3d h = cells_from_pixel_ * p.homogeneous();
  const Eigen::Vector2d at = h.head<2>() / h.z();
  const Eigen::Matrix2d turn =
      (cells_from_pixel_.topLeftCorner<2, 2>() - at * cells_from_pixel_.row(2).head<2>()) / h.z();
  const Window across(at.x(), blur_ * turn.row(0).norm());
  const Window down(at.y(), blur_ * turn.row(1).norm());
  double light = 0;
  for (int j = 0; j < down.count; ++j) {
    for (int i = 0; i < across.count; ++i) {
      light += across.share[i] * down.share[j] * Light(across.first + i, down.first + j);
    }
  }
  return light;
}

}  // namespace softforce::vision
