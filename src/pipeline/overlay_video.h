#pragma once

#include <filesystem>

#include "softforce/pipeline/frame_result.h"
#include "softforce/pipeline/world.h"
#include "softforce/vision/recording.h"
#include "softforce/vision/video_writer.h"

namespace softforce::pipeline {

// overlay.mp4: every camera's picture with body, markers and forces drawn over it, side by side.
class OverlayVideo {
 public:
  // World, rig and scene must outlive it.
  OverlayVideo(const std::filesystem::path& file, const scene::Scene& scene, const World& world,
               const camera::Rig& rig, int width);

  // May be called from several threads.
  cv::Mat Draw(const vision::FrameSet& frame, const FrameResult& result, const Eigen::Matrix3Xd& u,
               const Eigen::Isometry3d& T_rig_robot) const;

  void Add(const cv::Mat& drawn) { writer_.Add(drawn); }
  void Commit() { writer_.Commit(); }

 private:
  const scene::Scene& scene_;
  const World& world_;
  const camera::Rig& rig_;
  int width_;
  vision::VideoWriter writer_;
};

}  // namespace softforce::pipeline
