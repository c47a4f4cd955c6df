#include "render/stroke.h"

namespace softforce::render {
namespace {

constexpr int kPiecesPerLeg = 16;

// A part that goes on where the last one ended becomes one with it.
void Append(std::vector<Stroke>* strokes, const cv::Point2d& from, const cv::Point2d& to,
            bool hidden) {
  const bool continues = !strokes->empty() && strokes->back().hidden == hidden &&
                         strokes->back().points.back() == from;
  if (!continues) strokes->push_back({{from}, hidden});
  strokes->back().points.push_back(to);
}

}  // namespace

std::vector<Stroke> TracePath(const View& view, const DepthBuffer& depth,
                              const std::vector<Eigen::Vector3d>& path) {
  std::vector<Stroke> strokes;
  for (size_t leg = 0; leg + 1 < path.size(); ++leg) {
    Sight from = See(view, path[leg]);
    for (int i = 1; i <= kPiecesPerLeg; ++i) {
      const double share = static_cast<double>(i) / kPiecesPerLeg;
      const Sight to = See(view, path[leg] + share * (path[leg + 1] - path[leg]));
      if (from.visible && to.visible) {
        ForEachPart(depth, from, to, [&](double begin, double end, bool hidden) {
          Append(&strokes, Along(from, to, begin), Along(from, to, end), hidden);
        });
      }
      from = to;
    }
  }
  return strokes;
}

}  // namespace softforce::render
