#include "pipeline/parallel_detector.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace softforce::pipeline {

ParallelDetector::ParallelDetector(const scene::Scene& scene, const camera::Rig& rig)
    : detectors_([&scene, &rig] { return Detector(scene, rig); }), followers_(rig.cameras.size()) {}

std::vector<CameraDetections> ParallelDetector::Markers(const vision::FrameSet& set) {
  std::vector<CameraDetections> cameras(set.pictures.size());
  // Isolated: a thread that waits for the other cameras must not take up another frame meanwhile.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(size_t{0}, cameras.size(), [&](size_t c) {
      cameras[c] = detectors_.local().Markers(static_cast<int>(c), set.pictures[c], &followers_[c]);
    });
  });
  return cameras;
}

}  // namespace softforce::pipeline
