#include "pipeline/shape_memory.h"

#include <algorithm>
#include <utility>

#include "pipeline/camera_view.h"

namespace softforce::pipeline {
namespace {

// m, of the feature that differs most.
double Distance(const std::vector<PredictedFeature>& a, const std::vector<PredictedFeature>& b) {
  double furthest = 0;
  for (size_t f = 0; f < a.size(); ++f) {
    furthest = std::max(furthest, (a[f].position - b[f].position).norm());
  }
  return furthest;
}

// How far detections lie from the nearest marker: the sum of squares, each as a share of `reach`
// and 1 at the most. Hidden markers cost nothing.
double Misfit(const CameraView& view, double reach_px) {
  if (view.expected.empty()) return static_cast<double>(view.detections.size());
  double misfit = 0;
  for (const allocation::DetectedPixel& seen : view.detections) {
    double nearest = reach_px * reach_px;
    for (const int f : view.expected) {
      nearest = std::min(nearest, (seen.pixel - view.features[f].pixel).squaredNorm());
    }
    misfit += nearest / (reach_px * reach_px);
  }
  return misfit;
}

}  // namespace

bool ShapeMemory::IsNew(const std::vector<PredictedFeature>& features) const {
  return std::none_of(shapes_.begin(), shapes_.end(), [&](const Shape& shape) {
    return Distance(shape.features, features) < apart_;
  });
}

void ShapeMemory::Learn(const estimation::ForceEstimator::Memory& state,
                        const std::vector<PredictedFeature>& features) {
  shapes_.push_back({state, features});
  while (shapes_.size() > kMostShapes) Thin();
}

void ShapeMemory::Thin() {
  constexpr double kWiden = 1.2;
  apart_ *= kWiden;
  std::vector<Shape> all;
  std::swap(all, shapes_);
  // The latest ones first: they are the more likely to come again.
  for (auto shape = all.rbegin(); shape != all.rend(); ++shape) {
    if (IsNew(shape->features)) shapes_.push_back(std::move(*shape));
  }
  std::reverse(shapes_.begin(), shapes_.end());
}

std::vector<const Shape*> ShapeMemory::Resembling(const camera::Rig& rig,
                                                  const Eigen::Isometry3d& T_rig_robot,
                                                  const std::vector<CameraDetections>& cameras,
                                                  const ObserveOptions& options,
                                                  const std::vector<DotLook>& looks,
                                                  size_t most) const {
  std::vector<std::pair<double, const Shape*>> ranked;
  for (const Shape& shape : shapes_) {
    double misfit = 0;
    for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
      const CameraView view = ViewOf(c, rig.cameras[c], T_rig_robot, shape.features, cameras[c],
                                     options, looks.empty() ? DotLook() : looks[c]);
      misfit += Misfit(view, spacing_ * rig.cameras[c].lens.fx / view.nearest);
    }
    ranked.emplace_back(misfit, &shape);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const Shape*> best;
  for (size_t i = 0; i < std::min(most, ranked.size()); ++i) best.push_back(ranked[i].second);
  return best;
}

}  // namespace softforce::pipeline
