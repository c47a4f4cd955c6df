#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "softforce/vision/frame_source.h"

namespace softforce::vision {

struct RecorderOptions {
  double segment_s = 1;  // length of a video file; what a power failure can cost
  // Sets that wait to be compressed: at most so many, and none that is older than the newest by
  // more than this time, which is what a kill can cost. The oldest are dropped.
  int queue = 16;
  double longest_wait_s = 0.25;
  bool wait = false;  // instead, Add() waits until there is room: every set is in the files
  // For the folder's note, of each camera: where its pictures come from, and by how much (s) its
  // times were corrected, see LiveCamera::time_offset_s. A replay corrects what is missing.
  std::vector<std::string> sources;
  std::vector<double> time_offsets_s;

  void Check() const;  // throws InputError naming the option
};

struct RecorderReport {
  int64_t written = 0;  // sets that are in the files
  int64_t dropped = 0;  // sets that came faster than they could be compressed and written
  int queued = 0;
  int64_t bytes = 0;
  double seconds = 0;  // from the first set's time to the last one's
  double busy_s = 0;   // the time that compressing and writing took

  std::string BriefReport() const;  // one line
};

// Writes sets of pictures to a folder without losing a bit of them, on a thread of its own:
//   FOLDER/recording.yaml     what it is; `complete: true` once it was ended properly
//   FOLDER/<camera>/000000.mkv, 000001.mkv, …   segments (Matroska, lossless)
//   FOLDER/<camera>/times.csv   frame,time_s,camera_time_s,segment
// Each picture stands by itself and goes to the system at once, so that a program that is killed
// loses what waits in the queue and no more; finished segments are synced to the disk.
// vision::Recording plays FOLDER/<camera> as a camera's source, with the same pictures and times.
class Recorder {
 public:
  // Makes the folder. Throws InputError if it holds a recording or cannot be made.
  Recorder(const std::filesystem::path& folder, const std::vector<std::string>& cameras,
           const RecorderOptions& options = {});
  ~Recorder();  // ends the recording, if Finish() did not; errors are lost then

  // Takes a set; returns at once, unless told to wait. Throws InputError if an earlier one could
  // not be written (the disk is full).
  void Add(const FrameSet& frame);

  // Writes what waits and completes the files. Throws InputError like Add().
  void Finish();

  RecorderReport Report() const;  // from any thread

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Throws InputError if a recording cannot be made in `folder`, since it holds one or anything else.
void RefuseUsedFolder(const std::filesystem::path& folder);

}  // namespace softforce::vision
