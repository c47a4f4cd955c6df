#pragma once

#include <string>

namespace softforce::pipeline {

// How long one stage of a run took per frame, and how many frames waited for it.
struct StageTimes {
  std::string stage;
  int count = 0;
  double median_ms = 0, p90_ms = 0, p95_ms = 0, p99_ms = 0, max_ms = 0;
  double total_s = 0;     // over all frames; of several threads at once, their sum
  bool queued = false;    // frames can wait for it
  double queue_mean = 0;  // frames that waited behind the one that the stage took up
  int queue_max = 0;
};

}  // namespace softforce::pipeline
