#pragma once

#include <chrono>
#include <string>

namespace softforce::base {

// How far a long task is, on standard error: on a terminal one line with a bar that is rewritten;
// elsewhere a line at every tenth part, or every ten seconds if the end is not known, so that logs
// stay short and hold no control characters.
class Progress {
 public:
  // `total` <= 0: the end is not known (a live camera), and only the count and rate are shown.
  Progress(std::string label, int total);

  // `note`: what else to tell now, such as "3 waiting".
  void Update(int done, const std::string& note = "");
  void Finish();

 private:
  using Clock = std::chrono::steady_clock;
  struct Mark {
    Clock::time_point time;
    int done = 0;
  };

  // Whether `done` is worth a line now.
  bool Due(Clock::time_point now, int done);

  std::string label_;
  int total_;
  int done_ = 0;
  int last_shown_tenth_ = -1;
  bool terminal_;
  bool finished_ = false;
  Clock::time_point last_shown_;
  Mark start_;
  Mark older_, newer_;  // the rate shown is that since the older one, a few seconds ago
};

// Writes a line to standard error, in the place of a progress line on a terminal. From any thread.
void TellBesideProgress(const std::string& message);

// What a Progress tells: `per_second` <= 0 leaves out rate and time left, `bar` characters of bar.
std::string ProgressLine(const std::string& label, int done, int total, double per_second, int bar,
                         const std::string& note = "");

}  // namespace softforce::base
