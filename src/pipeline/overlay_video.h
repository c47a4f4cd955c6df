#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "pipeline/frame_pipeline.h"
#include "softforce/pipeline/overlay_layers.h"
#include "softforce/pipeline/world.h"
#include "softforce/render/force_chart.h"
#include "softforce/vision/video_writer.h"

namespace softforce::pipeline {

// overlay.mp4: every camera's picture with body, markers and forces drawn over it, side by side,
// and the forces over time below them.
class OverlayVideo {
 public:
  // World, rig and scene must outlive it. Without a file it only draws.
  OverlayVideo(const std::filesystem::path& file, const scene::Scene& scene, const World& world,
               const camera::Rig& rig, int width, const OverlayLayers& layers);

  // Whether the frames must pass AddStress, in their order, before they are drawn.
  bool wants_stress() const { return layers_.stress; }
  void AddStress(FrameInWork* frame);

  // The pictures. May be called from several threads.
  cv::Mat Draw(const FrameInWork& frame) const;

  // Adds a frame with its pictures as drawn; one after the other.
  void Add(const FrameResult& result, const cv::Mat& drawn);
  void Commit() { writer_->Commit(); }

 private:
  void Remember(const FrameResult& result);

  const scene::Scene& scene_;
  const World& world_;
  const camera::Rig& rig_;
  int width_;
  OverlayLayers layers_;
  std::optional<vision::VideoWriter> writer_;
  std::vector<render::ChartSeries> history_;  // of the time that the chart shows
  double first_s_ = NAN;
  double largest_stress_ = 0;  // Pa, so far
};

}  // namespace softforce::pipeline
