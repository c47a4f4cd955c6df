#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "softforce/pipeline/frame_result.h"
#include "softforce/pipeline/run_controls.h"

namespace softforce::pipeline {

// Takes what a force was when somebody asked for it as its zero, as the tare of a balance: the mean
// over the next usable frames is subtracted from then on. Its covariance is added; errors that both
// share cancel in truth, so that this is on the safe side. A force whose place is not known is
// followed by its identity, and one that was not there at the time keeps its own zero.
class Tare {
 public:
  static constexpr int kFrames = 10;  // that the mean is taken over

  // Frame by frame, in their order. Without `controls` nothing is done.
  explicit Tare(RunControls* controls) : controls_(controls) {}
  void Apply(FrameResult* result);

  // What was done, in words for a person.
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  struct Zero {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();       // N
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // N²
    int frames = 0;                                        // that it is the mean of
  };

  void Gather(const FrameResult& result);
  void Settle(int frame);

  RunControls* controls_;
  int asked_ = 0;              // the newest request that was seen
  int frames_ = 0;             // still to be gathered
  std::map<int, Zero> sums_;   // by identity, while they are gathered
  std::map<int, Zero> zeros_;  // in force
  std::vector<std::string> messages_;
};

}  // namespace softforce::pipeline
