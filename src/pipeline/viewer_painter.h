#pragma once

#include <memory>
#include <mutex>

#include "pipeline/force_history.h"
#include "pipeline/frame_pipeline.h"
#include "pipeline/frame_rate.h"
#include "pipeline/overlay_video.h"

namespace softforce::pipeline {

// What viewers need of a frame; what was detected in it stays behind.
std::shared_ptr<const FrameInWork> CopyForViewers(const FrameInWork& frame);

// Draws frames for those who look while a run goes on: some of the frames, on a thread of its own,
// with the forces of all frames so far over time.
class ViewerPainter {
 public:
  // World, rig and scene must outlive it.
  ViewerPainter(const scene::Scene& scene, const World& world, const camera::Rig& rig, int width,
                const OverlayLayers& layers);

  // Every frame in its order, when the run has it; from another thread than Draw.
  void Note(const FrameResult& result);

  // One of these frames, no wider than asked for. The run may have drawn it already.
  cv::Mat Draw(const FrameInWork& frame);

 private:
  int width_;
  OverlayVideo overlay_;
  std::mutex mutex_;
  ForceHistory history_;
  FrameRate rate_;
};

}  // namespace softforce::pipeline
