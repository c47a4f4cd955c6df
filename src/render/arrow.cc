#include "render/arrow.h"

#include <algorithm>

#include "render/palette.h"

namespace softforce::render {
namespace {

constexpr int kPieces = 32;             // of a shaft
constexpr double kHiddenOpacity = 0.8;  // of the parts behind the body

double Length(const std::vector<cv::Point2d>& points) {
  double length = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) length += cv::norm(points[i + 1] - points[i]);
  return length;
}

cv::Point2d Direction(const cv::Point2d& from, const cv::Point2d& to) {
  const double length = cv::norm(to - from);
  return length > 1e-9 ? (to - from) / length : cv::Point2d();
}

void DrawAlongSight(Brush* brush, const cv::Point2d& centre, bool towards_camera, double unit) {
  const double radius = 9 * unit;
  brush->PaintSeamed(kOrange, 1, unit, [&](double extra) {
    const double width = 2 * unit + extra;
    brush->Arc(centre, radius, 0, 360, width);
    if (towards_camera) {
      brush->Disc(centre, 3 * unit + extra / 2);
    } else {
      const double arm = 0.7 * radius;
      brush->Line(centre - cv::Point2d(arm, arm), centre + cv::Point2d(arm, arm), width);
      brush->Line(centre - cv::Point2d(arm, -arm), centre + cv::Point2d(arm, -arm), width);
    }
  });
}

// The pieces of the shaft outside the head, and the head's corners.
struct Shape {
  size_t pieces;
  std::vector<cv::Point2d> head;
};

Shape ShapeOf(const std::vector<cv::Point2d>& shaft, double unit) {
  const cv::Point2d tip = shaft.back();
  const double head_length = std::min(18 * unit, 0.6 * Length(shaft));
  size_t pieces = shaft.size() - 1;
  while (pieces > 1 && cv::norm(shaft[pieces] - tip) < 0.8 * head_length) --pieces;
  const cv::Point2d along = Direction(shaft[pieces - 1], tip);
  const cv::Point2d across(-along.y, along.x);
  const cv::Point2d base = tip - head_length * along;
  return {pieces, {tip, base + 0.45 * head_length * across, base - 0.45 * head_length * across}};
}

}  // namespace

Arrow PlaceArrow(const OverlayForce& force, const OverlayScene& scene, double metres_per_newton) {
  const Eigen::Vector3d shaft = metres_per_newton * force.force;
  bool pulls = false;
  if (scene.surface && scene.x && scene.surface->num_triangles() > 0) {
    const auto nearest = mesh::ClosestSurfacePoint(*scene.surface, *scene.x, force.p_robot);
    pulls = mesh::Normal(*scene.surface, *scene.x, nearest.at).dot(force.force) > 0;
  }
  if (pulls) return {force.p_robot, force.p_robot + shaft};
  return {force.p_robot - shaft, force.p_robot};
}

std::optional<ArrowPicture> PictureArrow(const View& view, const DepthBuffer& depth,
                                         const Arrow& arrow, const Eigen::Vector3d& place) {
  ArrowPicture picture;
  for (int i = 0; i <= kPieces; ++i) {
    const double share = static_cast<double>(i) / kPieces;
    const Sight sight = See(view, arrow.tail + share * (arrow.tip - arrow.tail));
    if (!sight.visible) return std::nullopt;
    picture.shaft.push_back(sight.pixel);
    if (i > 0) picture.hidden.push_back(depth.Hides(sight.pixel, sight.inverse_depth));
  }
  picture.pulls = place == arrow.tail;
  picture.free_end = picture.pulls ? picture.shaft.back() : picture.shaft.front();
  picture.outwards =
      Direction(picture.pulls ? picture.shaft.front() : picture.shaft.back(), picture.free_end);
  return picture;
}

void DrawArrow(Brush* brush, const View& view, const Arrow& arrow, const ArrowPicture& picture) {
  const double unit = view.unit;
  if (Length(picture.shaft) < 8 * unit) {
    const Eigen::Vector3d direction = view.T_camera_robot.linear() * (arrow.tip - arrow.tail);
    DrawAlongSight(brush, picture.shaft.back(), direction.z() < 0, unit);
    return;
  }
  const Shape shape = ShapeOf(picture.shaft, unit);
  for (const bool hidden : {true, false}) {
    brush->PaintSeamed(kOrange, hidden ? kHiddenOpacity : 1, unit, [&](double extra) {
      for (size_t i = 0; i < shape.pieces; ++i) {
        if (picture.hidden[i] != hidden) continue;
        brush->Line(picture.shaft[i], picture.shaft[i + 1], 4 * unit + extra);
      }
      if (picture.pulls && picture.hidden.front() == hidden) {
        brush->Disc(picture.shaft.front(), 4.5 * unit + extra / 2);
      }
      if (picture.hidden.back() != hidden) return;
      brush->Polygon(shape.head);
      if (extra == 0) return;
      for (size_t i = 0; i < 3; ++i) {
        brush->Line(shape.head[i], shape.head[(i + 1) % 3], extra);
      }
    });
  }
}

}  // namespace softforce::render
