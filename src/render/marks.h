#pragma once

#include "render/brush.h"
#include "render/stroke.h"
#include "softforce/render/overlay.h"

namespace softforce::render {

double MarkRadius(double unit);  // px

// Ring if seen, half a ring if one camera sees it, dashed ring if hidden, x if rejected.
void DrawMark(Brush* brush, MarkerMark mark, const cv::Point2d& pixel, double unit);

// The cable as a line, dashed where the body hides it, with a knob where it is attached.
void DrawStrokes(Brush* brush, const View& view, const std::vector<Stroke>& cable);

// The points of a polyline cut into dashes as long as the gaps between them.
std::vector<std::vector<cv::Point2d>> Dashes(const std::vector<cv::Point2d>& points, double length);

}  // namespace softforce::render
