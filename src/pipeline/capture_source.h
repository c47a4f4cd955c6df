#pragma once

#include "pipeline/marker_source.h"

namespace softforce::pipeline {

// Points of a motion-capture file, which the scene names.
class CaptureSource : public MarkerSource {
 public:
  // Reads the file. Throws InputError for options of cameras.
  CaptureSource(const scene::Scene& scene, const RunOptions& options);

  Standing Start(const Tell& tell) override;
  const camera::Rig& rig() const override { return no_cameras_; }
  std::string StageName() const override { return "read"; }
  bool Next(FrameInWork* frame) override;
  void Detect(FrameInWork* frame) override;
  void Estimate(const World& world, FrameInWork* frame, Tracker* tracker) override;
  int expected_frames() const override;
  int last_frame() const override { return points_.frames.back().frame; }
  std::vector<std::filesystem::path> Inputs() const override;
  std::vector<std::string> ShortOf() const override;

 private:
  bool IsAskedFor(int frame) const;

  const scene::Scene& scene_;
  const RunOptions& options_;
  const camera::Rig no_cameras_;
  const scene::MeasuredPoints points_;
  Standing standing_;
  size_t next_ = 0;
  bool stopped_ = false;  // from outside, before the end
};

// Where the frame of a scene's motion capture is: as the scene says, or the robot's own.
Standing PlaceOfCapture(const scene::Measured& measured);

}  // namespace softforce::pipeline
