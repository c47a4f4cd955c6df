#pragma once

#include <memory>
#include <vector>

#include "vision/av_reader.h"
#include "vision/picture_stream.h"
#include "vision/recorded_folder.h"

namespace softforce::vision {

// One camera's folder in what a Recorder wrote, its segments one after another, with the times that
// were recorded. What a recorder that was killed had not completed is left out: every picture
// announced is there.
class RecordedCamera : public PictureStream {
 public:
  // Throws InputError if the folder is no such, a segment is missing or damaged before the last, or
  // nothing was recorded.
  explicit RecordedCamera(std::filesystem::path folder);

  const std::filesystem::path& file() const override { return folder_; }
  cv::Size size() const override { return size_; }
  int announced_frames() const override { return static_cast<int>(times_.size()); }
  std::optional<cv::Mat> Next() override;
  double time_s() const override { return last_.time_s; }
  double camera_time_s() const override { return last_.camera_time_s; }
  void Rewind() override;
  bool unfinished() const override { return unfinished_; }
  double period_s() const override;
  double time_offset_s() const override { return time_offset_s_; }

 private:
  void CheckSegments();

  std::filesystem::path folder_;
  std::vector<RecordedTime> times_;
  bool unfinished_;
  double time_offset_s_;
  cv::Size size_;
  size_t next_ = 0;
  RecordedTime last_;
  std::unique_ptr<AvReader> segment_;
};

}  // namespace softforce::vision
