#include "softforce/render/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "render/arrow.h"
#include "render/body_net.h"
#include "render/colour_scale.h"
#include "render/labels.h"
#include "render/marks.h"
#include "render/palette.h"
#include "render/region.h"
#include "render/skin.h"

namespace softforce::render {
namespace {

TextStyle Style(double scale, double unit) {
  return {scale * unit, std::max(1, static_cast<int>(std::lround(unit)))};
}

cv::Mat3b InColour(const cv::Mat& picture) {
  cv::Mat3b colour;
  if (picture.channels() == 1) {
    cv::cvtColor(picture, colour, cv::COLOR_GRAY2BGR);
  } else {
    picture.copyTo(colour);
  }
  return colour;
}

cv::Rect BoxAt(const cv::Point2d& centre, double radius) {
  const int side = static_cast<int>(std::ceil(2 * radius));
  return {static_cast<int>(std::floor(centre.x - radius)),
          static_cast<int>(std::floor(centre.y - radius)), side, side};
}

std::string ForceText(const OverlayForce& force) {
  std::string text = fmt::format("{} {:.3f} N", force.label, force.force.norm());
  if (std::isfinite(force.sd_norm) && force.sd_norm > 0) {
    text += fmt::format(" ±{:.3f}", force.sd_norm);
  }
  return text;
}

// What is drawn so far, and the words that are still to come on top of it.
struct Drawing {
  View view;
  Brush brush;
  std::vector<Label> labels;
  std::vector<cv::Rect> occupied;  // boxes that words should not cover
};

void DrawForce(Drawing* drawing, const DepthBuffer& depth, const OverlayForce& force,
               const OverlayScene& scene, double metres_per_newton) {
  if (!force.p_robot.allFinite() || !force.force.allFinite()) return;
  const View& view = drawing->view;
  const Arrow arrow = PlaceArrow(force, scene, metres_per_newton);
  const auto picture = PictureArrow(view, depth, arrow, force.p_robot);
  if (!picture) return;
  DrawRegion(&drawing->brush, view, force.p_robot, force.place_covariance, kOrange);
  DrawArrow(&drawing->brush, view, arrow, *picture);
  DrawRegion(&drawing->brush, view, picture->pulls ? arrow.tip : arrow.tail,
             metres_per_newton * metres_per_newton * force.covariance, kOrange);
  for (const cv::Point2d& point : picture->shaft) {
    drawing->occupied.push_back(BoxAt(point, 6 * view.unit));
  }
  drawing->labels.push_back({ForceText(force), Style(0.6, view.unit), kOrange, true,
                             picture->free_end, 14 * view.unit, picture->outwards});
}

void DrawMarker(Drawing* drawing, const OverlayMarker& marker) {
  const View& view = drawing->view;
  const Sight sight = See(view, marker.p_robot);
  if (!sight.visible) return;
  DrawRegion(&drawing->brush, view, marker.p_robot, marker.covariance, kPurple);
  DrawMark(&drawing->brush, marker.mark, sight.pixel, view.unit);
  drawing->occupied.push_back(BoxAt(sight.pixel, MarkRadius(view.unit)));
  drawing->labels.push_back({marker.label,
                             Style(0.45, view.unit),
                             kWhite,
                             false,
                             sight.pixel,
                             MarkRadius(view.unit) + 1,
                             {}});
}

// A diamond; fainter behind the body.
void DrawCandidate(Drawing* drawing, const DepthBuffer& depth, const OverlayCandidate& candidate) {
  const View& view = drawing->view;
  const Sight sight = See(view, candidate.p_robot);
  if (!sight.visible) return;
  const bool hidden = depth.Hides(sight.pixel, sight.inverse_depth);
  const double arm = 5 * view.unit;
  const cv::Point2d across(arm, 0), up(0, arm), at = sight.pixel;
  const std::vector<cv::Point2d> outline{at + across, at + up, at - across, at - up, at + across};
  drawing->brush.PaintSeamed(kWhite, hidden ? 0.4 : 0.9, 0.75 * view.unit, [&](double extra) {
    drawing->brush.Polyline(outline, 1.5 * view.unit + extra);
  });
}

void DrawAxes(Drawing* drawing, const DepthBuffer& depth, double length) {
  const View& view = drawing->view;
  static const std::array<cv::Vec3b, 3> kColours{kVermillion, kGreen, kSkyBlue};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d tip = length * Eigen::Vector3d::Unit(axis);
    const Sight sight = See(view, tip);
    if (!sight.visible || !See(view, Eigen::Vector3d::Zero()).visible) continue;
    for (const Stroke& stroke : TracePath(view, depth, {Eigen::Vector3d::Zero(), tip})) {
      drawing->brush.PaintSeamed(
          kColours[axis], stroke.hidden ? 0.4 : 1, 0.75 * view.unit,
          [&](double extra) { drawing->brush.Polyline(stroke.points, 2 * view.unit + extra); });
    }
    drawing->labels.push_back({std::string(1, static_cast<char>('x' + axis)),
                               Style(0.5, view.unit),
                               kColours[axis],
                               false,
                               sight.pixel,
                               4 * view.unit,
                               {}});
  }
}

}  // namespace

cv::Mat DrawOverlay(const cv::Mat& grey, const camera::Camera& camera,
                    const Eigen::Isometry3d& T_camera_robot, const OverlayScene& scene,
                    const OverlayOptions& options) {
  assert(grey.type() == CV_8UC1 || grey.type() == CV_8UC3);
  assert((scene.surface == nullptr) == (scene.x == nullptr));
  cv::Mat3b picture = InColour(grey);
  const double unit = std::max(0.4, std::min(picture.cols, picture.rows) / 1024.0);
  Drawing drawing{{&camera, T_camera_robot, picture.size(), unit}, Brush(picture), {}, {}};

  const mesh::Surface no_surface{Eigen::MatrixXi(3, 0), {}};
  const Eigen::Matrix3Xd no_nodes(3, 0);
  const mesh::Surface& surface = scene.surface ? *scene.surface : no_surface;
  const Eigen::Matrix3Xd& x = scene.x ? *scene.x : no_nodes;
  const BodyPicture body = PictureBody(drawing.view, surface, x);

  if (scene.field) DrawSkin(picture, drawing.view, surface, x, body, *scene.field);
  if (options.net) {
    // Over colours that mean something a net of no colour, and little of it.
    DrawNet(&drawing.brush, drawing.view, surface, x, body, scene.field ? kWhite : kSkyBlue,
            scene.field ? 0.12 : 0.4);
  }
  if (scene.axes > 0) DrawAxes(&drawing, body.depth, scene.axes);
  for (const OverlayCable& cable : scene.cables) {
    const std::vector<Stroke> strokes = TracePath(drawing.view, body.depth, cable.path);
    DrawCable(&drawing.brush, drawing.view, strokes);
    for (const Stroke& stroke : strokes) {
      for (const cv::Point2d& point : stroke.points) {
        drawing.occupied.push_back(BoxAt(point, 3 * unit));
      }
    }
  }
  const TextStyle caption_style = Style(0.6, unit);
  const cv::Point corner(static_cast<int>(12 * unit), static_cast<int>(12 * unit));
  if (!scene.caption.empty()) {
    drawing.occupied.push_back(TextBlockBox(scene.caption, corner, caption_style));
  }
  if (scene.field) {
    const cv::Point right(picture.cols - corner.x, corner.y);
    drawing.occupied.push_back(
        DrawColourBar(&drawing.brush, picture, *scene.field, right, Style(0.5, unit), unit));
  }
  for (const OverlayCandidate& candidate : scene.candidates) {
    DrawCandidate(&drawing, body.depth, candidate);
  }
  for (const OverlayForce& force : scene.forces) {
    DrawForce(&drawing, body.depth, force, scene, options.metres_per_newton);
  }
  for (const OverlayMarker& marker : scene.markers) DrawMarker(&drawing, marker);
  const std::vector<cv::Rect> boxes = PlaceLabels(drawing.labels, drawing.occupied, picture.size());
  for (size_t i = boxes.size(); i-- > 0;) DrawLabel(&drawing.brush, drawing.labels[i], boxes[i]);
  DrawTextBlock(&drawing.brush, scene.caption, corner, caption_style);
  return picture;
}

}  // namespace softforce::render
