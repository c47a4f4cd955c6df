#include "vision/tag_pictures.h"

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace softforce::testing {

Corners SquareAt(const Eigen::Vector2d& middle, double side, double angle) {
  const Eigen::Rotation2Dd turn(angle);
  const double half = 0.5 * side;
  return {middle + turn * Eigen::Vector2d(-half, -half),
          middle + turn * Eigen::Vector2d(half, -half), middle + turn * Eigen::Vector2d(half, half),
          middle + turn * Eigen::Vector2d(-half, half)};
}

void PaintTag(const vision::TagCells& tag, const Corners& corners, SyntheticScene* scene) {
  const auto low = static_cast<float>(tag.margin);
  const auto high = static_cast<float>(tag.cells.cols - tag.margin);
  const std::array<cv::Point2f, 4> in_cells{{{low, low}, {high, low}, {high, high}, {low, high}}};
  std::array<cv::Point2f, 4> in_picture;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double reach = 0;
  for (int i = 0; i < 4; ++i) {
    in_picture[i] = {static_cast<float>(corners[i].x()), static_cast<float>(corners[i].y())};
    middle += 0.25 * corners[i];
  }
  for (const Eigen::Vector2d& corner : corners)
    reach = std::max(reach, 2.5 * (corner - middle).norm());
  const cv::Matx33d to_cells = cv::getPerspectiveTransform(in_picture.data(), in_cells.data());
  scene->Paint(middle, reach, [&](const Eigen::Vector2d& p) -> double {
    const cv::Vec3d cell = to_cells * cv::Vec3d(p.x(), p.y(), 1);
    const int x = static_cast<int>(std::floor(cell[0] / cell[2]));
    const int y = static_cast<int>(std::floor(cell[1] / cell[2]));
    if (x < 0 || y < 0 || x >= tag.cells.cols || y >= tag.cells.rows) return NAN;
    return tag.cells(y, x) > 0 ? 220 : 30;
  });
}

}  // namespace softforce::testing
