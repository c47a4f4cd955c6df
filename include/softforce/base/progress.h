#pragma once

#include <chrono>
#include <string>

namespace softforce::base {

// How far a long task is, on standard error: one line that is rewritten on a terminal; a line at
// every tenth part elsewhere, so that logs stay short.
class Progress {
 public:
  // `total` <= 0: the end is not known (a live camera), and only the count and rate are shown.
  Progress(std::string label, int total);

  void Update(int done);
  void Finish();

 private:
  std::string label_;
  int total_;
  int done_ = 0;
  int last_shown_tenth_ = -1;
  bool terminal_;
  bool finished_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_shown_;
};

}  // namespace softforce::base
