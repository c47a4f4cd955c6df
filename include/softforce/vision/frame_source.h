#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace softforce::vision {

// The pictures that all cameras of a rig took at one moment.
struct FrameSet {
  int frame = -1;                     // counted from 0 at the first set that the source delivers
  double time_s = NAN;                // s, from the first set, which is at 0
  std::vector<cv::Mat> pictures;      // one per camera in the rig's order, 8-bit grey, CV_8UC1
  std::vector<double> camera_time_s;  // s, of each picture, counted like time_s
};

// How one camera of a source fares.
struct CameraReport {
  enum class State { kOpening, kRunning, kAway, kEnded };

  std::string camera;
  State state = State::kOpening;
  int64_t received = 0;  // pictures that came
  int64_t paired = 0;    // of these, in a set
  int64_t unpaired = 0;  // of these, no partner within the tolerance
  int64_t unsure = 0;    // of these, taken at a time that cannot be told well enough to pair them
  int64_t missed = 0;    // never came, as gaps between the time stamps show
  int reopened = 0;      // how often it was lost and opened again
  double rate_hz = NAN;  // pictures per second, of late; NaN where it is not measured

  std::string BriefReport() const;  // one line
};

struct SourceReport {
  std::vector<CameraReport> cameras;
  int64_t delivered = 0;   // sets that Next() gave
  int64_t dropped = 0;     // sets that were complete, but that nobody fetched in time
  int queued = 0;          // sets that wait for Next()
  std::string truncation;  // of a recording: which file ended early and where; empty: complete

  std::string BriefReport() const;  // one line: sets, drops, queue
  std::string FullReport() const;   // with a line per camera
};

// Where sets of pictures come from: a recording, or live cameras. One thread fetches the sets;
// every other member may be called from any thread at any time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // The next set; live cameras make the caller wait for it. Nothing at the end of a recording and
  // after Stop().
  virtual std::optional<FrameSet> Next() = 0;

  // Live cameras cannot go back: what must see the first sets twice has to keep them. Sets that are
  // not fetched in time are dropped, the oldest first.
  virtual bool live() const = 0;

  // Sets that will come in all, as far as the files say; 0 if that is not known, as of live ones.
  virtual int announced_frames() const = 0;

  // Ends a Next() that waits, and lets every later one give nothing.
  virtual void Stop() = 0;

  virtual SourceReport Report() const = 0;

  // What a person should hear, such as a camera that went away or came back; each is told once.
  virtual std::vector<std::string> TakeMessages() = 0;
};

}  // namespace softforce::vision
