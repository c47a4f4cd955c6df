#pragma once

#include <memory>

#include "pipeline/frame_pipeline.h"
#include "pipeline/overlay_video.h"

namespace softforce::pipeline {

// What viewers need of a frame; what was detected in it stays behind.
std::shared_ptr<const FrameInWork> CopyForViewers(const FrameInWork& frame);

// Draws frames for those who look while a run goes on: some of the frames, on a thread of its own.
class ViewerPainter {
 public:
  // World, rig and scene must outlive it.
  ViewerPainter(const scene::Scene& scene, const World& world, const camera::Rig& rig, int width,
                const OverlayLayers& layers);

  // No wider than asked for. The run may have drawn the frame already.
  cv::Mat Draw(const FrameInWork& frame);

 private:
  int width_;
  OverlayVideo overlay_;
};

}  // namespace softforce::pipeline
