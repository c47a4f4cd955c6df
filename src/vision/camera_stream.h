#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "softforce/vision/live_cameras.h"

namespace softforce::vision {

// Seconds of the clock that V4L2 stamps pictures with: CLOCK_MONOTONIC.
inline double MonotonicNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// How long to wait for a camera: until a moment, and not after someone asked to stop.
class Patience {
 public:
  explicit Patience(const std::atomic<bool>* stop) : stop_(stop) {}
  void Renew(double seconds) { until_s_ = MonotonicNow() + seconds; }
  bool over() const { return stopped() || MonotonicNow() > until_s_; }
  bool stopped() const { return *stop_; }
  double left_s() const { return until_s_ - MonotonicNow(); }

 private:
  const std::atomic<bool>* stop_;
  double until_s_ = 0;
};

// One live camera that is open.
class CameraStream {
 public:
  struct Grabbed {
    cv::Mat grey;                    // CV_8UC1
    double arrival_s = NAN;          // when its last byte came, MonotonicNow()
    std::optional<double> stream_s;  // the stream's own time, if it has one
    bool exact = false;              // that is of MonotonicNow()'s clock
  };

  virtual ~CameraStream() = default;

  // Waits for the next picture; nothing if patience ran out, or the camera is gone: `problem`.
  virtual std::optional<Grabbed> Grab() = 0;

  const std::string& problem() const { return problem_; }

 protected:
  std::string problem_;
};

// Null if it cannot be opened while patience lasts; then `problem` tells why.
using OpenedStream = std::unique_ptr<CameraStream>;
OpenedStream OpenStream(const LiveCamera& camera, const LiveOptions& options, Patience* patience,
                        std::string* problem);

OpenedStream OpenDevice(const LiveCamera& camera, const LiveOptions& options, Patience* patience,
                        std::string* problem);
OpenedStream OpenPipeline(const LiveCamera& camera, Patience* patience, std::string* problem);
OpenedStream OpenUrl(const LiveCamera& camera, Patience* patience, std::string* problem);

}  // namespace softforce::vision
