#pragma once

#include <string>
#include <vector>

#include "pipeline/frame_pipeline.h"
#include "softforce/pipeline/world.h"
#include "softforce/report/run_report.h"

namespace softforce::pipeline {

// The body's surface as pages show it, at rest and in frames of a run.
class BodyViews {
 public:
  // The world must outlive it.
  explicit BodyViews(const World& world);

  const report::BodyShape& shape() const { return shape_; }
  report::BodyView ViewOf(const FrameInWork& frame) const;

 private:
  const World& world_;
  report::BodyShape shape_;
  std::vector<int> nodes_;  // of the mesh, that the shape's are
};

// What a force goes by from frame to frame.
std::string ForceName(const ForceResult& force);

// In words, in the order of MarkerStatus.
std::vector<std::string> MarkerStatusNames();

}  // namespace softforce::pipeline
