#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/registration.h"
#include "pipeline/source_watch.h"
#include "softforce/pipeline/run.h"
#include "softforce/vision/frame_source.h"
#include "softforce/vision/recorder.h"

namespace softforce::pipeline {

// Where a run's frames come from, a recording or live cameras, and which of them it processes. All
// frames that Next() gives are recorded, if the options say so. For one thread, unless said
// otherwise.
class FrameFeed {
 public:
  // Opens files, but no cameras as yet: they do not wait for what else is to be done. Scene, rig
  // and options must outlive it. Throws InputError for sources that cannot be used.
  FrameFeed(const scene::Scene& scene, const camera::Rig& rig, const RunOptions& options);
  ~FrameFeed();

  // Opens live cameras, and from now on passes on what the source has to tell.
  void Start(SourceWatch::Tell tell);

  // Shows frames that the rig is placed by. Next() gives them all the same.
  ShowFirstFrames FirstFrames();

  // The next frame to process; nothing at the end, after the time that was asked for, or if it was
  // stopped.
  std::optional<vision::FrameSet> Next();

  // After the last frame: completes the recording that is made, if one is.
  void Finish();

  bool live() const { return live_; }
  // s, by which the time stamps of each camera are taken to be late; after Start().
  std::vector<double> TimeOffsets() const;

  int announced_frames() const { return source_->announced_frames(); }  // of all that there are
  int expected_frames() const;                                          // 0 if the end is not known
  vision::SourceReport Report() const { return source_->Report(); }     // from any thread
  std::optional<vision::RecorderReport> Recorded() const;
  std::vector<std::filesystem::path> Inputs() const;

  // Why the results should not be relied on, in words for a person.
  std::vector<std::string> ShortOf() const;

  // What happened to the cameras, in words for a person.
  std::vector<std::string> Messages() const;

 private:
  std::optional<vision::FrameSet> Take();
  void Record(const vision::FrameSet& set);
  bool ToBeRecorded() const;
  std::filesystem::path RecordFolder();
  void EndRecording();
  void RefuseToRecordAPart() const;
  bool Stopped() const { return options_.stop != nullptr && *options_.stop; }

  const scene::Scene& scene_;
  const camera::Rig& rig_;
  const RunOptions& options_;
  const std::vector<vision::Recording::Source> sources_;
  const bool live_;
  std::unique_ptr<vision::FrameSource> source_;
  std::deque<vision::FrameSet> kept_;  // looked at, not yet given
  std::optional<vision::Recorder> recorder_;
  int recordings_ = 0;                 // on request
  std::vector<std::string> recorded_;  // on request, in words for a person
  std::optional<SourceWatch> watch_;
  bool stopped_ = false;  // from outside, before the end
};

}  // namespace softforce::pipeline
