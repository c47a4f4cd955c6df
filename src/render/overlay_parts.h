#pragma once

#include <vector>

#include "render/brush.h"
#include "render/depth_buffer.h"
#include "render/labels.h"
#include "render/view.h"
#include "softforce/render/overlay.h"

namespace softforce::render {

// A picture being drawn over, and the words that are still to come on top of it.
struct Drawing {
  View view;
  Brush brush;
  std::vector<Label> labels;       // those that must find a place first come first
  std::vector<cv::Rect> occupied;  // boxes that words should not cover
};

// The letters' size for a picture 1024 px high, fitted to the view's picture.
TextStyle Style(const View& view, double scale);

// Each draws one thing, and leaves its words and the boxes that it fills to the drawing.
void DrawForce(Drawing* drawing, const DepthBuffer& depth, const OverlayForce& force,
               const OverlayScene& scene, double metres_per_newton);
void DrawMarker(Drawing* drawing, const OverlayMarker& marker);
void DrawCandidate(Drawing* drawing, const DepthBuffer& depth, const OverlayCandidate& candidate);
void DrawAxes(Drawing* drawing, const DepthBuffer& depth, double length);
void DrawCable(Drawing* drawing, const DepthBuffer& depth, const OverlayCable& cable);

}  // namespace softforce::render
