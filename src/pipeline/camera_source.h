#pragma once

#include "pipeline/frame_feed.h"
#include "pipeline/marker_source.h"
#include "pipeline/parallel_detector.h"
#include "pipeline/tag_oddities.h"

namespace softforce::pipeline {

// Markers in the pictures of cameras, of which a recording or the cameras themselves are read, and
// a watch over where the rig stands.
class CameraSource : public MarkerSource {
 public:
  CameraSource(const scene::Scene& scene, const RunOptions& options);

  Standing Start(const Tell& tell) override;
  const camera::Rig& rig() const override { return rig_; }
  std::string StageName() const override { return feed_.live() ? "capture" : "decode"; }
  bool Next(FrameInWork* frame) override;
  Stage::Order DetectOrder() const override;
  void Detect(FrameInWork* frame) override;
  void Estimate(const World& world, FrameInWork* frame, Tracker* tracker) override;
  void Finish() override { feed_.Finish(); }

  bool live() const override { return feed_.live(); }
  int expected_frames() const override { return feed_.expected_frames(); }
  int last_frame() const override { return feed_.announced_frames() - 1; }
  std::vector<std::filesystem::path> Inputs() const override { return feed_.Inputs(); }
  vision::SourceReport Report() const override { return feed_.Report(); }
  std::optional<vision::RecorderReport> Recorded() const override { return feed_.Recorded(); }
  std::vector<RigEvent> RigEvents() const override;
  std::vector<std::string> ShortOf() const override { return feed_.ShortOf(); }
  std::vector<std::string> Messages() const override;

 private:
  const scene::Scene& scene_;
  const RunOptions& options_;
  const camera::Rig rig_;
  FrameFeed feed_;
  ParallelDetector detector_;
  std::optional<RigWatch> watch_;
  TagOddities oddities_;
};

}  // namespace softforce::pipeline
