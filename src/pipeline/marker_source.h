#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/frame_pipeline.h"
#include "pipeline/registration.h"
#include "pipeline/rig_watch.h"
#include "softforce/pipeline/run.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {

// Where a run learns of its markers: from cameras (pictures in which they are detected) or from
// motion capture (points in space). A frame passes Next, Detect and Estimate.
class MarkerSource {
 public:
  using Tell = std::function<void(const std::string& message)>;

  virtual ~MarkerSource() = default;

  // Opens what does not wait, when all else is ready, and finds where its frame, the rig's, is.
  virtual Standing Start(const Tell& tell) = 0;

  // The cameras; none of motion capture.
  virtual const camera::Rig& rig() const = 0;

  // What the time spent in Next goes by.
  virtual std::string StageName() const = 0;

  // Fills in the next frame to process; false at the end, after the time that was asked for, or if
  // it was stopped. For one thread.
  virtual bool Next(FrameInWork* frame) = 0;

  // Finds what may be markers; the order in which Detect takes the frames.
  virtual Stage::Order DetectOrder() const { return Stage::Order::kAny; }
  virtual void Detect(FrameInWork* frame) = 0;

  // The forces of a frame, the frames in their order.
  virtual void Estimate(const World& world, FrameInWork* frame, Tracker* tracker) = 0;

  // After the last frame.
  virtual void Finish() {}

  virtual bool live() const { return false; }
  virtual int expected_frames() const = 0;  // 0 if the end is not known
  virtual int last_frame() const = 0;       // of the recording; −1 if it is not known
  virtual std::vector<std::filesystem::path> Inputs() const = 0;
  virtual vision::SourceReport Report() const { return {}; }  // from any thread
  virtual std::optional<vision::RecorderReport> Recorded() const { return std::nullopt; }
  virtual std::vector<RigEvent> RigEvents() const { return {}; }

  // Why the results should not be relied on, and what else happened; in words for a person.
  virtual std::vector<std::string> ShortOf() const = 0;
  virtual std::vector<std::string> Messages() const { return {}; }
};

// What the scene has. Throws InputError for input, or options, that do not go with it. Scene and
// options must outlive it.
std::unique_ptr<MarkerSource> OpenMarkerSource(const scene::Scene& scene,
                                               const RunOptions& options);

}  // namespace softforce::pipeline
