#include "render/marks.h"

#include <algorithm>

#include "render/palette.h"

namespace softforce::render {
namespace {

constexpr double kLeastWidth = 1.8;  // px, of strokes that have to be told apart by colour

cv::Vec3b MarkColour(MarkerMark mark) {
  switch (mark) {
    case MarkerMark::kSeen:
      return kGreen;
    case MarkerMark::kOneCamera:
      return kYellow;
    case MarkerMark::kHidden:
      return kPurple;
    case MarkerMark::kRejected:
      break;
  }
  return kVermillion;
}

}  // namespace

double MarkRadius(double unit) { return 13 * unit; }

void DrawMark(Brush* brush, MarkerMark mark, const cv::Point2d& pixel, double unit) {
  const double radius = MarkRadius(unit);
  const auto shape = [&](double extra) {
    const double width = std::max(kLeastWidth, 2 * unit) + extra;
    switch (mark) {
      case MarkerMark::kSeen:
        brush->Arc(pixel, radius, 0, 360, width);
        break;
      case MarkerMark::kOneCamera:
        brush->Arc(pixel, radius, 90, 270, width);
        break;
      case MarkerMark::kHidden:
        for (int from = 0; from < 360; from += 60) {
          brush->Arc(pixel, radius, from, from + 30, width);
        }
        break;
      case MarkerMark::kRejected: {
        const double arm = 0.7 * radius;
        brush->Line(pixel - cv::Point2d(arm, arm), pixel + cv::Point2d(arm, arm), width);
        brush->Line(pixel - cv::Point2d(arm, -arm), pixel + cv::Point2d(arm, -arm), width);
        break;
      }
    }
  };
  brush->PaintSeamed(MarkColour(mark), 1, std::max(kLeastWidth / 2, unit), shape);
}

std::vector<std::vector<cv::Point2d>> Dashes(const std::vector<cv::Point2d>& points,
                                             double length) {
  std::vector<std::vector<cv::Point2d>> dashes;
  bool inked = true;
  double left = length;  // px, of the current dash or gap
  if (!points.empty()) dashes.push_back({points.front()});
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    cv::Point2d at = points[i];
    double remaining = cv::norm(points[i + 1] - at);
    while (remaining > left) {
      at += left / remaining * (points[i + 1] - at);
      remaining -= left;
      left = length;
      if (inked) {
        dashes.back().push_back(at);
      } else {
        dashes.push_back({at});
      }
      inked = !inked;
    }
    left -= remaining;
    if (inked) dashes.back().push_back(points[i + 1]);
  }
  return dashes;
}

void DrawStrokes(Brush* brush, const View& view, const std::vector<Stroke>& cable) {
  if (cable.empty()) return;
  brush->PaintSeamed(kWhite, 0.9, 0.75 * view.unit, [&](double extra) {
    for (const Stroke& stroke : cable) {
      if (!stroke.hidden) {
        brush->Polyline(stroke.points, 2 * view.unit + extra);
        continue;
      }
      for (const auto& dash : Dashes(stroke.points, 5 * view.unit)) {
        brush->Polyline(dash, view.unit + extra);
      }
    }
    brush->Disc(cable.front().points.front(), 4 * view.unit + extra / 2);
  });
}

}  // namespace softforce::render
