#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/frame_source.h"

namespace softforce::vision {

// Video files of all cameras of a rig, or what a Recorder wrote of them, decoded side by side.
// Frame k of one belongs to frame k of every other; unless the cameras' time stamps are late by
// more than was corrected when they were recorded, and not all alike: then pictures belong together
// by their corrected times, within half a period.
class Recording : public FrameSource {
 public:
  struct Source {
    std::string camera;          // a camera's name in the rig
    std::filesystem::path file;  // a video, or the folder of a camera in a recorded one
  };

  // Opens one source per camera of the rig. Throws InputError if a camera has no source or a source
  // no camera, a file is missing or no video, its pictures are not of the camera's resolution, or
  // the files announce different numbers of frames.
  //
  // `time_offsets_s` (camera → s) are taken instead of the rig's own; throws InputError if it names
  // a camera that is not there. Where neither says anything, that of the recording stays.
  //
  // An MP4 file that was cut off before its index ("moov") was written is salvaged where possible:
  // see mp4_salvage.h. It then counts as truncated.
  Recording(const camera::Rig& rig, const std::vector<Source>& sources,
            const std::map<std::string, double>& time_offsets_s = {});
  ~Recording() override;
  Recording(Recording&&) noexcept;

  // Frames that the files announce; a truncated file delivers fewer, and so do files whose pictures
  // belong together by their times. 0 if none says, as a Matroska
  // file that was never closed.
  int announced_frames() const override;

  // The next frame of all cameras, or nothing at the end of the shortest file. Where a file was cut
  // off, pictures that cannot be told from their successors are not delivered: with H.264's usual
  // order these are the last few.
  std::optional<FrameSet> Next() override;

  // s, by which the time stamps of each camera are taken to be late.
  const std::vector<double>& time_offsets_s() const;

  // Starts again at frame 0.
  void Rewind();

  bool live() const override { return false; }
  void Stop() override;
  SourceReport Report() const override;
  std::vector<std::string> TakeMessages() override;

  // After the end: which file ended early and where, in words for a person; empty if all are
  // complete.
  const std::string& truncation() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
