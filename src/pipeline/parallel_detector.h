#pragma once

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "pipeline/registration.h"

namespace softforce::pipeline {

// Detects the markers in all pictures of a frame at once. AprilTag's detectors keep notes while
// they work, so every thread has its own; how markers move is followed from frame to frame, so
// frames must come one after another and in order.
class ParallelDetector {
 public:
  // Both must outlive it.
  ParallelDetector(const scene::Scene& scene, const camera::Rig& rig);

  std::vector<CameraDetections> Markers(const vision::FrameSet& set);

  // As Detector::FiducialsNear.
  std::vector<std::vector<vision::Tag>> FiducialsNear(
      const vision::FrameSet& set, const std::vector<CameraDetections>& markers,
      const std::vector<std::vector<Detector::FiducialPlace>>& places) {
    return detectors_.local().FiducialsNear(set, markers, places);
  }

 private:
  tbb::enumerable_thread_specific<Detector> detectors_;
  std::vector<MarkerFollower> followers_;  // of each camera
};

}  // namespace softforce::pipeline
