#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/registration.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {

// Watches over where the rig stands by the markers alone, while no fiducials are in view: all of
// them being off alike, rigidly, over several frames, means that the rig, or the body, was moved.
// That can be told, but not corrected. If no forces explain such frames, looking for them takes
// long and is in vain: then only a frame that looks like the last good one, and a few others, are
// worth it.
class BlindWatch {
 public:
  struct Finding {
    enum class Kind { kOffAlike, kBack };

    Kind kind = Kind::kOffAlike;
    int frame = -1;                // the first that shows it
    double moved = 0, turned = 0;  // m and rad, of the markers' centre against the model
  };

  // What was estimated in a frame. X, u: nodes at rest and their displacements.
  struct Estimated {
    int frame;
    bool usable;
    const std::vector<CameraDetections>& detections;
    const std::vector<MarkerObservation>& observations;
    const Eigen::Matrix3Xd& X;
    const Eigen::Matrix3Xd& u;
    double common_model_error;  // see EstimatorOptions
    const Standing& standing;   // of the rig
  };

  std::optional<Finding> Look(const Estimated& estimated);

  // Whether forces should be looked for in the next frame.
  bool WorthATry(const std::vector<CameraDetections>& detections);

  // Fiducials are in view: they know better.
  void Forget();

 private:
  struct Misfit {
    bool off = false;
    double moved = 0, turned = 0;
  };
  static std::optional<Misfit> Compare(const Estimated& estimated);

  using Places = std::vector<std::vector<Eigen::Vector2d>>;  // px, per camera
  static Places PlacesOf(const std::vector<CameraDetections>& detections);

  Places last_good_;
  int failed_since_ = -1, failed_ = 0;  // frame; estimates in a row
  int off_since_ = -1, off_ = 0;        // frame; estimates in a row
  bool lost_ = false;                   // told, and no forces explain it
  int untried_ = 0, next_try_ = 0;      // frames, while lost
};

}  // namespace softforce::pipeline
