#pragma once

#include <map>
#include <string>
#include <vector>

#include "softforce/pipeline/run.h"

namespace softforce::pipeline {

// What the frames of a run add up to.
struct RunTally {
  RunReport report;
  std::map<std::string, int> frame_statuses, marker_statuses;
  int markers_expected_absent = 0;  // of the hidden ones: no camera could have seen them
  // Frames in which another number of forces, or another face, explains the markers nearly as well.
  int frames_in_doubt = 0;
  std::vector<double> reduced_chi2;  // of each frame with forces

  void Add(const FrameResult& result);

  // After the last frame. Both in words for a person; `messages`: what happened to the cameras;
  // `short_of`: why the results should not be relied on, besides what the frames say.
  void Judge(const std::vector<std::string>& messages, const std::vector<std::string>& short_of);

 private:
  void WarnOfCameras();
};

}  // namespace softforce::pipeline
