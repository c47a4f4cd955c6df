#pragma once

#include <atomic>

namespace softforce::pipeline {

// What viewers (the window, the live page) ask of a run while it goes on. Any thread may set it;
// the run looks at it from frame to frame. RunOptions::controls points to it, and
// RunOptions::stop to its `stop`.
struct RunControls {
  // Counted up by one who asks: the mean of each force over the next frames becomes its zero, see
  // Tare.
  std::atomic<int> tares{0};
  // Whether to record what is processed, each time it is switched on in a folder of its own,
  // OUT/recording-1, -2, …; of no effect with RunOptions::record, which records all.
  std::atomic<bool> record{false};
  std::atomic<bool> pause{false};  // take up no new frame; live cameras drop theirs meanwhile
  std::atomic<bool> stop{false};   // end after the frames in work, with complete files

  // Answers of the run.
  std::atomic<int> tared{0};            // the newest of `tares` that was carried out
  std::atomic<bool> recording{false};   // files are being written
  std::atomic<bool> can_record{false};  // there are pictures, and they are not recorded anyway
};

}  // namespace softforce::pipeline
