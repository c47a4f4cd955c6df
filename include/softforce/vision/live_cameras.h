#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/frame_source.h"

namespace softforce::vision {

enum class SourceKind { kDevice, kUrl, kPipeline, kFile };

// What a source's text stands for: a device ("/dev/video0", or its number "0"), a URL ("rtsp://…",
// "http://…", "tcp://…"), a GStreamer pipeline (elements joined by " ! "), else a file or folder. A
// file that exists is a file, whatever its name.
SourceKind KindOf(const std::string& source);
inline bool IsLive(const std::string& source) { return KindOf(source) != SourceKind::kFile; }

struct LiveOptions {
  // Pictures belong together if they were taken within this time. At most half the shortest time
  // between two pictures of a camera is used, however large: beyond, a picture had two partners.
  double tolerance_s = 1;
  // How long a picture waits for its partners: more than the cameras' delays differ by.
  double max_wait_s = 0.5;
  int queue = 4;  // sets that wait to be fetched; when it is full, the oldest is dropped
  double open_timeout_s = 10;  // for the first picture of each camera
  double stall_s = 2;          // without a picture: the camera is opened again
  double settle_s = 1;         // after opening, to learn how a stream's clock stands to this one
  double longest_pause_s = 5;  // between two attempts to open a camera that went away
  // Of devices (V4L2): what is asked of the driver; 0 and empty: what it does by itself.
  double rate_hz = 0;
  std::string pixel_format;  // four letters, as "MJPG"
  // Set from outside while cameras are being opened: leave it, there will be no sets.
  const std::atomic<bool>* stop = nullptr;

  void Check() const;  // throws InputError naming the option
};

struct LiveCamera {
  std::string name;
  std::string source;        // a live one, see KindOf()
  cv::Size size;             // px, that its pictures must have; empty: any
  double time_offset_s = 0;  // s, by which its time stamps are late; see EstimateTimeOffset()
};

// The cameras of a rig in its order, each with its source and the size that it was calibrated for.
// Throws InputError if a camera has no source, or a source no camera. `time_offsets_s` (camera → s)
// are taken instead of the rig's own.
std::vector<LiveCamera> LiveCamerasOf(const camera::Rig& rig,
                                      const std::map<std::string, std::string>& sources,
                                      const std::map<std::string, double>& time_offsets_s = {});

// Cameras that are grabbed together, each on a thread of its own, and paired by time stamp. A
// camera that stalls or goes away is opened again, for ever, and does not hold up the others;
// without it there are no sets. docs/live.md tells which clock the time stamps are of, and what
// pairing can and cannot do.
class LiveCameras : public FrameSource {
 public:
  // Opens all cameras and waits for a picture of each. Throws InputError if there is none within
  // the time allowed, if its size is wrong, or if names are missing or given twice.
  explicit LiveCameras(std::vector<LiveCamera> cameras, const LiveOptions& options = {});
  ~LiveCameras() override;

  std::optional<FrameSet> Next() override;
  bool live() const override { return true; }
  int announced_frames() const override { return 0; }
  void Stop() override;
  SourceReport Report() const override;
  std::vector<std::string> TakeMessages() override;

  const std::vector<LiveCamera>& cameras() const;  // `size` is now that of their pictures

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A Recording if all sources are files, LiveCameras if all are live. Throws InputError for a
// mixture, and whatever either throws.
std::unique_ptr<FrameSource> OpenFrameSource(
    const camera::Rig& rig, const std::map<std::string, std::string>& sources,
    const LiveOptions& options = {}, const std::map<std::string, double>& time_offsets_s = {});

}  // namespace softforce::vision
