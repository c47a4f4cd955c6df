#pragma once

#include <chrono>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "softforce/pipeline/stage_times.h"

namespace softforce::pipeline {

// How long each stage took in each frame, and how many frames waited for it. Stages may run on
// several threads.
class StageClock {
 public:
  // Runs `work` and books its time under `stage`.
  template <typename Work>
  auto Measure(const std::string& stage, Work&& work) {
    const Booking booking(this, stage);
    return work();
  }

  // Books how many frames wait for the stage, while it takes one up.
  void BookQueue(const std::string& stage, int waiting);

  // In the order of first use; of so many of the newest times of each.
  std::vector<StageTimes> Report(size_t newest = std::numeric_limits<size_t>::max()) const;

 private:
  class Booking {
   public:
    Booking(StageClock* clock, const std::string& stage)
        : clock_(clock), stage_(stage), start_(std::chrono::steady_clock::now()) {}
    ~Booking() {
      clock_->Book(stage_, std::chrono::duration<double, std::milli>(
                               std::chrono::steady_clock::now() - start_)
                               .count());
    }
    Booking(const Booking&) = delete;
    Booking& operator=(const Booking&) = delete;

   private:
    StageClock* clock_;
    const std::string& stage_;
    std::chrono::steady_clock::time_point start_;
  };

  struct Stage {
    std::string name;
    std::vector<float> times_ms;
    long long taken_up = 0, waiting = 0;  // frames; the sum of those that waited
    int longest_queue = 0;
  };

  void Book(const std::string& stage, double milliseconds);
  Stage& Find(const std::string& stage);  // with the mutex held

  mutable std::mutex mutex_;
  std::vector<Stage> stages_;
};

}  // namespace softforce::pipeline
