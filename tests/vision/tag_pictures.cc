#include "vision/tag_pictures.h"

#include <apriltag.h>
#include <tag16h5.h>
#include <tag25h9.h>
#include <tag36h11.h>
#include <tagStandard41h12.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace softforce::testing {
namespace {

TagCells DrawWith(apriltag_family_t* family, int id) {
  image_u8_t* image = apriltag_to_image(family, static_cast<uint32_t>(id));
  TagCells tag;
  tag.cells = cv::Mat1b(image->height, image->width, image->buf, image->stride).clone();
  tag.margin = (family->total_width - family->width_at_border) / 2;
  image_u8_destroy(image);
  return tag;
}

}  // namespace

TagCells DrawTag(const std::string& family, int id) {
  const auto draw = [id](auto create, auto destroy) {
    apriltag_family_t* made = create();
    const TagCells tag = DrawWith(made, id);
    destroy(made);
    return tag;
  };
  if (family == "tagStandard41h12") {
    return draw(tagStandard41h12_create, tagStandard41h12_destroy);
  }
  TagCells tag = family == "tag16h5"   ? draw(tag16h5_create, tag16h5_destroy)
                 : family == "tag25h9" ? draw(tag25h9_create, tag25h9_destroy)
                                       : draw(tag36h11_create, tag36h11_destroy);
  cv::rotate(tag.cells, tag.cells, cv::ROTATE_180);
  return tag;
}

Corners SquareAt(const Eigen::Vector2d& middle, double side, double angle) {
  const Eigen::Rotation2Dd turn(angle);
  const double half = 0.5 * side;
  return {middle + turn * Eigen::Vector2d(-half, -half),
          middle + turn * Eigen::Vector2d(half, -half), middle + turn * Eigen::Vector2d(half, half),
          middle + turn * Eigen::Vector2d(-half, half)};
}

void PaintTag(const TagCells& tag, const Corners& corners, SyntheticScene* scene) {
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
