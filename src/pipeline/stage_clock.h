#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace softforce::pipeline {

// How long each stage took in each frame.
class StageClock {
 public:
  // Runs `work` and books its time under `stage`.
  template <typename Work>
  auto Measure(const std::string& stage, Work&& work) {
    const Booking booking(this, stage);
    return work();
  }

  struct Percentiles {
    std::string stage;
    int count = 0;
    double median_ms = 0, p90_ms = 0, p95_ms = 0, p99_ms = 0, max_ms = 0;
  };
  std::vector<Percentiles> Report() const;  // in the order of first use

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

  void Book(const std::string& stage, double milliseconds);

  std::vector<std::pair<std::string, std::vector<double>>> times_ms_;
};

}  // namespace softforce::pipeline
