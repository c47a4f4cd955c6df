#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"

namespace softforce::vision {

// The pictures that all cameras of a rig took at one moment.
struct FrameSet {
  int frame = -1;                 // counted from 0 at the start of the recording
  double time_s = NAN;            // from the first camera's container, 0 at the start
  std::vector<cv::Mat> pictures;  // one per camera in the rig's order, 8-bit grey, CV_8UC1
};

// Video files of all cameras of a rig, decoded side by side. Frame k of one file belongs to frame k
// of every other.
class Recording {
 public:
  struct Source {
    std::string camera;  // a camera's name in the rig
    std::filesystem::path file;
  };

  // Opens one source per camera of the rig. Throws InputError if a camera has no source or a source
  // no camera, a file is missing or no video, its pictures are not of the camera's resolution, or
  // the files announce different numbers of frames.
  //
  // An MP4 file that was cut off before its index ("moov") was written is salvaged where possible:
  // see mp4_salvage.h. It then counts as truncated.
  Recording(const camera::Rig& rig, const std::vector<Source>& sources);
  ~Recording();
  Recording(Recording&&) noexcept;

  // Frames that the files announce; a truncated file delivers fewer. 0 if none says, as a Matroska
  // file that was never closed.
  int announced_frames() const;

  // The next frame of all cameras, or nothing at the end of the shortest file. Where a file was cut
  // off, pictures that cannot be told from their successors are not delivered: with H.264's usual
  // order these are the last few.
  std::optional<FrameSet> Next();

  // Starts again at frame 0.
  void Rewind();

  // After the end: which file ended early and where, in words for a person; empty if all are
  // complete.
  const std::string& truncation() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
