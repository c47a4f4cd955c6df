#pragma once

#include <chrono>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/stage_clock.h"
#include "softforce/pipeline/frame_result.h"
#include "softforce/pipeline/observe.h"
#include "softforce/vision/recording.h"

namespace softforce::pipeline {

// A frame on its way through a run. Each stage reads what those before it have set.
struct FrameInWork {
  vision::FrameSet set;
  std::chrono::steady_clock::time_point taken_up;  // when the run had its pictures
  std::vector<CameraDetections> detections;
  std::vector<std::vector<vision::Tag>> fiducials;  // per camera; empty: not looked for
  FrameResult result;
  Eigen::Isometry3d T_rig_robot;    // where the rig stands in this frame
  Eigen::Matrix3Xd u;               // m, displacements of the nodes in this frame
  double largest_displacement = 0;  // m, of any node in the frames up to this one
  Eigen::VectorXd stress;           // Pa, von Mises, at the nodes; empty: not asked for
  double largest_stress = 0;        // Pa, where its scale ends
  cv::Mat overlay;                  // the picture with everything drawn over it
};

// One step of the work on every frame.
struct Stage {
  enum class Order {
    kInOrder,  // one frame at a time, in the order of the frames: the stage may have a memory
    kAny       // several frames at once: the stage must be a function of its frame alone
  };

  std::string name;
  Order order = Order::kInOrder;
  std::function<void(FrameInWork*)> work;
};

// Where the frames come from: fills one in, or says that there are no more. Called for one frame
// at a time.
struct FrameInput {
  std::string name;
  std::function<bool(FrameInWork*)> next;
};

// As many as the machine has cores for this program.
int DefaultThreads();

// Takes every frame through all stages on `threads` threads (1: the calling one alone), with no
// more than `frames_in_flight` frames between input and end, and no more memory than those need.
// What comes out does not depend on the number of threads. An exception from a stage ends the work
// and is thrown on here, after all threads have come to rest.
void RunStages(const FrameInput& input, const std::vector<Stage>& stages, int threads,
               int frames_in_flight, StageClock* clock);

}  // namespace softforce::pipeline
