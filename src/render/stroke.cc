#include "render/stroke.h"

#include <algorithm>
#include <cmath>

namespace softforce::render {
namespace {

constexpr double kTestEvery = 2;  // px, between tests of visibility
constexpr int kPiecesPerLeg = 16;

void Append(std::vector<Stroke>* strokes, const std::vector<Stroke>& more) {
  for (const Stroke& stroke : more) {
    const bool continues = !strokes->empty() && strokes->back().hidden == stroke.hidden &&
                           strokes->back().points.back() == stroke.points.front();
    if (!continues) {
      strokes->push_back(stroke);
    } else {
      auto& points = strokes->back().points;
      points.insert(points.end(), stroke.points.begin() + 1, stroke.points.end());
    }
  }
}

}  // namespace

std::vector<Stroke> CutByVisibility(const DepthBuffer& depth, const Sight& a, const Sight& b) {
  const cv::Point2d ab = b.pixel - a.pixel;
  const int steps = std::max(1, static_cast<int>(std::ceil(cv::norm(ab) / kTestEvery)));
  std::vector<Stroke> strokes;
  for (int i = 0; i < steps; ++i) {
    const double middle = (i + 0.5) / steps;
    const bool hidden = depth.Hides(a.pixel + middle * ab,
                                    a.inverse_depth + middle * (b.inverse_depth - a.inverse_depth));
    const cv::Point2d end = i + 1 == steps ? b.pixel : a.pixel + (i + 1.0) / steps * ab;
    if (!strokes.empty() && strokes.back().hidden == hidden) {
      strokes.back().points.back() = end;
    } else {
      const cv::Point2d start = strokes.empty() ? a.pixel : strokes.back().points.back();
      strokes.push_back({{start, end}, hidden});
    }
  }
  return strokes;
}

std::vector<Stroke> TracePath(const View& view, const DepthBuffer& depth,
                              const std::vector<Eigen::Vector3d>& path) {
  std::vector<Stroke> strokes;
  for (size_t leg = 0; leg + 1 < path.size(); ++leg) {
    Sight from = See(view, path[leg]);
    for (int i = 1; i <= kPiecesPerLeg; ++i) {
      const double share = static_cast<double>(i) / kPiecesPerLeg;
      const Sight to = See(view, path[leg] + share * (path[leg + 1] - path[leg]));
      if (from.visible && to.visible) Append(&strokes, CutByVisibility(depth, from, to));
      from = to;
    }
  }
  return strokes;
}

}  // namespace softforce::render
