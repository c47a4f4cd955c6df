#include "render/overlay_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/arrow.h"
#include "render/marks.h"
#include "render/palette.h"
#include "render/region.h"
#include "render/stroke.h"

namespace softforce::render {
namespace {

cv::Rect BoxAt(const cv::Point2d& centre, double radius) {
  const int side = static_cast<int>(std::ceil(2 * radius));
  return {static_cast<int>(std::floor(centre.x - radius)),
          static_cast<int>(std::floor(centre.y - radius)), side, side};
}

// Boxes along a line, so close that no letter fits between them.
void Occupy(Drawing* drawing, const std::vector<cv::Point2d>& line, double radius) {
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const cv::Point2d step = line[i + 1] - line[i];
    const int pieces = std::max(1, static_cast<int>(cv::norm(step) / (2 * radius)));
    for (int k = 0; k <= pieces; ++k) {
      drawing->occupied.push_back(BoxAt(line[i] + k * step / pieces, radius));
    }
  }
}

std::string ForceText(const OverlayForce& force) {
  std::string text = fmt::format("{} {:.3f} N", force.label, force.force.norm());
  if (std::isfinite(force.sd_norm) && force.sd_norm > 0) {
    text += fmt::format(" ±{:.3f}", kHalfWidth * force.sd_norm);
  }
  return text;
}

}  // namespace

TextStyle Style(const View& view, double scale) {
  return {scale * view.text, std::max(1.0, view.text)};
}

void DrawForce(Drawing* drawing, const DepthBuffer& depth, const OverlayForce& force,
               const OverlayScene& scene, double metres_per_newton) {
  if (!force.p_robot.allFinite() || !force.force.allFinite()) return;
  const View& view = drawing->view;
  const Arrow arrow = PlaceArrow(force, scene, metres_per_newton);
  const auto picture = PictureArrow(view, depth, arrow, force.p_robot);
  if (!picture) return;
  Occupy(drawing, DrawRegion(&drawing->brush, view, force.p_robot, force.place_covariance, kOrange),
         3 * view.unit);
  DrawArrow(&drawing->brush, view, arrow, *picture);
  DrawRegion(&drawing->brush, view, picture->pulls ? arrow.tip : arrow.tail,
             metres_per_newton * metres_per_newton * force.covariance, kOrange);
  Occupy(drawing, picture->shaft, 6 * view.unit);
  drawing->labels.push_back({ForceText(force), Style(view, 0.6), kOrange, true, picture->free_end,
                             14 * view.unit, picture->outwards});
}

void DrawMarker(Drawing* drawing, const OverlayMarker& marker) {
  const View& view = drawing->view;
  const Sight sight = See(view, marker.p_robot);
  if (!sight.visible) return;
  DrawRegion(&drawing->brush, view, marker.p_robot, marker.covariance, kPurple);
  DrawMark(&drawing->brush, marker.mark, sight.pixel, view.unit);
  drawing->occupied.push_back(BoxAt(sight.pixel, MarkRadius(view.unit)));
  drawing->labels.push_back(
      {marker.label, Style(view, 0.5), kWhite, false, sight.pixel, MarkRadius(view.unit) + 1, {}});
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
  drawing->occupied.push_back(BoxAt(at, arm));
  drawing->brush.PaintSeamed(kWhite, hidden ? 0.4 : 0.9, 0.75 * view.unit, [&](double extra) {
    drawing->brush.Polyline(outline, 1.5 * view.unit + extra);
  });
}

void DrawAxes(Drawing* drawing, const DepthBuffer& depth, double length) {
  const View& view = drawing->view;
  static const std::array<cv::Vec3b, 3> kColours{kVermillion, kGreen, kSkyBlue};
  const Sight origin = See(view, Eigen::Vector3d::Zero());
  if (!origin.visible) return;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d tip = length * Eigen::Vector3d::Unit(axis);
    const Sight sight = See(view, tip);
    if (!sight.visible) continue;
    for (const Stroke& stroke : TracePath(view, depth, {Eigen::Vector3d::Zero(), tip})) {
      drawing->brush.PaintSeamed(
          kColours[axis], stroke.hidden ? 0.4 : 1, 0.75 * view.unit,
          [&](double extra) { drawing->brush.Polyline(stroke.points, 2 * view.unit + extra); });
    }
    Occupy(drawing, {origin.pixel, sight.pixel}, 4 * view.unit);
    const cv::Point2d along = sight.pixel - origin.pixel;
    drawing->labels.push_back({std::string(1, static_cast<char>('x' + axis)), Style(view, 0.5),
                               kColours[axis], false, sight.pixel, 4 * view.unit,
                               along / std::max(1.0, cv::norm(along))});
  }
}

void DrawCable(Drawing* drawing, const DepthBuffer& depth, const OverlayCable& cable) {
  const std::vector<Stroke> strokes = TracePath(drawing->view, depth, cable.path);
  DrawStrokes(&drawing->brush, drawing->view, strokes);
  for (const Stroke& stroke : strokes) {
    Occupy(drawing, stroke.points, 3 * drawing->view.unit);
  }
}

}  // namespace softforce::render
