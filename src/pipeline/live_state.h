#pragma once

#include <deque>
#include <string>
#include <vector>

#include "pipeline/body_views.h"
#include "softforce/pipeline/run.h"

namespace softforce::pipeline {

// The forces of a frame, as the live page plots them.
struct LivePoint {
  double time_s = 0;
  std::vector<ForceResult> forces;
};

// The forces of the last minute, by the frames' times. Its memory is bounded: where frames are
// many, every other old one is given up.
class LiveHistory {
 public:
  static constexpr double kSpan = 60;  // s
  static constexpr size_t kMost = 1500;

  void Add(const FrameResult& result);
  const std::deque<LivePoint>& points() const { return points_; }

 private:
  std::deque<LivePoint> points_;
};

// What the live page is told of a run besides its pictures.
struct LiveFacts {
  std::string scene, run;  // `run` differs from run to run
  bool live = false;
  int expected = 0, processed = 0;  // frames; 0 expected: not known
  double rate = 0;                  // frames/s, of late
  double latency_ms = 0;            // from having the newest frame's pictures to its forces
  int64_t dropped = 0;              // sets
  std::vector<StageTimes> stages;   // of late
  int pictures = 0;
  std::string ended;  // how it ended; empty: it goes on
  bool usable = false;
};

std::string LiveStateJson(const LiveFacts& facts, const FrameResult& result,
                          const RunControls* controls);
std::string LiveHistoryJson(const std::deque<LivePoint>& points);

}  // namespace softforce::pipeline
