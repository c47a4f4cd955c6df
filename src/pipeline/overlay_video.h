#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "pipeline/force_history.h"
#include "pipeline/frame_pipeline.h"
#include "softforce/pipeline/overlay_layers.h"
#include "softforce/pipeline/world.h"
#include "softforce/render/easel.h"
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

  // The pictures, and below them room for the forces over time. `note` is one more line of the
  // caption. What is drawn is what frames.bin keeps of a frame, no more. May be called from several
  // threads.
  cv::Mat Draw(const FrameInWork& frame, const std::string& note = "") const;

  // Fills that room of the pictures drawn of a frame, if there is one.
  void DrawHistory(const FrameInWork& frame, const ForceHistory& history, cv::Mat drawn) const;

  // Adds a frame whose pictures have been drawn, with the forces up to it below them; one after the
  // other.
  void Add(const FrameInWork& frame);
  void Commit() { writer_->Commit(); }

 private:
  class Borrowed;

  const scene::Scene& scene_;
  const World& world_;
  const camera::Rig& rig_;
  int width_;
  OverlayLayers layers_;
  std::optional<vision::VideoWriter> writer_;
  ForceHistory history_;
  double largest_stress_ = 0;  // Pa, so far
  mutable std::mutex mutex_;
  mutable std::vector<render::Easel> easels_;  // that nobody draws on; as many as threads drew
};

}  // namespace softforce::pipeline
