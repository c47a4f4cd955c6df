#include "softforce/render/overlay.h"

#include <algorithm>
#include <cassert>

#include "render/body_net.h"
#include "render/colour_scale.h"
#include "render/easel_state.h"
#include "render/overlay_parts.h"
#include "render/palette.h"
#include "render/skin.h"

namespace softforce::render {
namespace {

constexpr double kFullHeight = 1024;  // px, of a picture in which strokes and letters have size 1
constexpr double kLeastStrokes = 0.4;
constexpr double kLeastText = 0.75;  // capitals are 8 px high then

View MakeView(const camera::Camera& camera, const Eigen::Isometry3d& T_camera_robot,
              const cv::Size& size) {
  const double unit = std::min(size.width, size.height) / kFullHeight;
  return {&camera, T_camera_robot, size, std::max(unit, kLeastStrokes), std::max(unit, kLeastText)};
}

void DrawBody(Drawing* drawing, cv::Mat3b picture, const OverlayScene& scene, bool net,
              Easel::State* easel) {
  if (scene.surface == nullptr) {
    easel->body.depth.Clear(picture.size());
    return;
  }
  const mesh::Surface& surface = *scene.surface;
  PictureBody(drawing->view, surface, *scene.x, &easel->body);
  if (scene.field) {
    DrawSkin(picture, drawing->view, surface, *scene.x, easel->body, *scene.field);
  }
  if (!net) return;
  // Over colours that mean something a net of no colour, and little of it.
  DrawNet(&drawing->brush, drawing->view, surface, *scene.x, easel->body, easel->edges.Of(surface),
          scene.field ? kWhite : kSkyBlue, scene.field ? 0.12 : 0.4);
}

}  // namespace

void DrawOverlay(cv::Mat3b picture, const camera::Camera& camera,
                 const Eigen::Isometry3d& T_camera_robot, const OverlayScene& scene,
                 const OverlayOptions& options, Easel* easel) {
  assert((scene.surface == nullptr) == (scene.x == nullptr));
  Easel own;
  Easel* const used = easel != nullptr ? easel : &own;
  Drawing drawing{MakeView(camera, T_camera_robot, picture.size()), Brush(picture, used), {}, {}};
  const View& view = drawing.view;
  DrawBody(&drawing, picture, scene, options.net, &used->state());
  const DepthBuffer& depth = used->state().body.depth;

  const int margin = cvRound(12 * view.unit);
  const int wide =
      scene.field ? picture.cols - ColourBarWidth(*scene.field, Style(view, 0.5)) : picture.cols;
  const TextStyle caption_style = Fitted(scene.caption, Style(view, 0.6), wide - 3 * margin);
  const cv::Point corner(margin, margin);
  if (!scene.caption.empty()) {
    drawing.occupied.push_back(TextBlockBox(scene.caption, corner, caption_style));
  }
  if (scene.field) {
    drawing.occupied.push_back(DrawColourBar(&drawing.brush, picture, *scene.field,
                                             {picture.cols - margin, margin}, Style(view, 0.5)));
  }
  for (const OverlayCable& cable : scene.cables) DrawCable(&drawing, depth, cable);
  for (const OverlayCandidate& candidate : scene.candidates) {
    DrawCandidate(&drawing, depth, candidate);
  }
  for (const OverlayForce& force : scene.forces) {
    DrawForce(&drawing, depth, force, scene, options.metres_per_newton);
  }
  if (scene.axes > 0) DrawAxes(&drawing, depth, scene.axes);
  for (const OverlayMarker& marker : scene.markers) DrawMarker(&drawing, marker);
  const std::vector<cv::Rect> boxes = PlaceLabels(drawing.labels, drawing.occupied, picture.size());
  for (size_t i = boxes.size(); i-- > 0;) DrawLabel(&drawing.brush, drawing.labels[i], boxes[i]);
  DrawTextBlock(&drawing.brush, scene.caption, corner, caption_style);
}

}  // namespace softforce::render
