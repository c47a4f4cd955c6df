#include "softforce/vision/dots.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "softforce/base/input_error.h"
#include "vision/dot_candidates.h"
#include "vision/dot_refinement.h"

namespace softforce::vision {

void DotOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("dots: ") + option, rule);
  };
  require(min_diameter >= 3, "min_diameter", "must be 3 px or more");
  require(max_diameter >= min_diameter && std::isfinite(max_diameter), "max_diameter",
          "must be finite and not below min_diameter");
  require(min_axis_ratio > 0 && min_axis_ratio <= 1, "min_axis_ratio", "must lie in (0, 1]");
  require(min_contrast >= 1 && min_contrast <= 255, "min_contrast",
          "must lie between 1 and 255 grey levels");
  require(max_ellipse_misfit > 0, "max_ellipse_misfit", "must be greater than 0");
}

std::vector<Dot> DetectDots(const cv::Mat& grey, const DotOptions& options) {
  return DetectDotsIn(grey, {cv::Rect(0, 0, grey.cols, grey.rows)}, options);
}

std::vector<Dot> DetectDotsIn(const cv::Mat& grey, const std::vector<cv::Rect>& areas,
                              const DotOptions& options) {
  options.Check();
  CV_Assert(grey.type() == CV_8UC1);
  std::vector<Dot> dots;
  if (grey.empty()) return dots;
  std::set<std::pair<double, double>> looked_at;  // centres: areas may overlap
  for (const cv::Rect& area : areas) {
    const cv::Rect inside = area & cv::Rect(0, 0, grey.cols, grey.rows);
    if (inside.empty()) continue;
    for (const Ellipse& blob : FindEllipticBlobs(grey, inside, options)) {
      if (!looked_at.emplace(blob.centre().x(), blob.centre().y()).second) continue;
      if (const std::optional<Dot> dot = MeasureDot(grey, blob, options)) dots.push_back(*dot);
    }
  }
  std::sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) {
    return std::make_pair(a.centroid.y(), a.centroid.x()) <
           std::make_pair(b.centroid.y(), b.centroid.x());
  });
  return dots;
}

}  // namespace softforce::vision
