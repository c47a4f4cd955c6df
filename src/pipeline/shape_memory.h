#pragma once

#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "softforce/pipeline/observe.h"

namespace softforce::pipeline {

// A shape in which the body was seen.
struct Shape {
  estimation::ForceEstimator::Memory state;
  std::vector<PredictedFeature> features;  // where they were, turned where
};

// Shapes in which the body was seen, spread over all that it did: where to look for it after it was
// lost, since a body that is at work goes back to where it was before.
class ShapeMemory {
 public:
  static constexpr size_t kMostShapes = 64;

  // `spacing`: m, the smallest between markers. Shapes kept have some marker half of it apart at
  // least, more if there are too many.
  explicit ShapeMemory(double spacing) : spacing_(spacing), apart_(0.5 * spacing) {}

  // Whether no shape like that is kept.
  bool IsNew(const std::vector<PredictedFeature>& features) const;
  void Learn(const estimation::ForceEstimator::Memory& state,
             const std::vector<PredictedFeature>& features);

  // The shapes about whose markers the detections lie best, best first, `most` of them at most.
  std::vector<const Shape*> Resembling(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                                       const std::vector<CameraDetections>& cameras,
                                       const ObserveOptions& options,
                                       const std::vector<DotLook>& looks, size_t most) const;

  size_t size() const { return shapes_.size(); }

 private:
  void Thin();

  double spacing_, apart_;  // m
  std::vector<Shape> shapes_;
};

}  // namespace softforce::pipeline
