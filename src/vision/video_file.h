#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <vector>

#include "vision/mp4_salvage.h"
#include "vision/picture_stream.h"

namespace softforce::vision {

// One video, decoded picture by picture to 8-bit grey.
class VideoFile : public PictureStream {
 public:
  // Throws InputError if the file is missing or no video. If it is an MP4 without its index, it is
  // salvaged with the help of one of the `siblings`, recorded beside it with the same settings.
  VideoFile(std::filesystem::path file, const std::vector<std::filesystem::path>& siblings);

  const std::filesystem::path& file() const override { return file_; }
  cv::Size size() const override { return size_; }
  int announced_frames() const override { return announced_; }

  // Nothing at the end, or where the file is damaged. Every picture delivered is the frame that it
  // counts as: pictures that the decoder still gives behind a gap are left out.
  std::optional<cv::Mat> Next() override;
  double time_s() const override { return time_s_; }
  double camera_time_s() const override { return time_s_; }
  void Rewind() override;
  double period_s() const override { return frames_per_second_ > 0 ? 1 / frames_per_second_ : 0; }

 private:
  // A decoded picture and what its container says of its time; nothing where OpenCV does not know.
  struct Decoded {
    cv::Mat grey;
    std::optional<double> stamp_s;
  };

  bool Open();
  std::optional<Decoded> Decode();
  void DecodeTail(Decoded first);

  std::filesystem::path file_;
  std::optional<SalvagedVideo> salvaged_;
  cv::VideoCapture capture_;
  cv::Size size_;
  int announced_ = 0;
  double frames_per_second_ = 0;
  std::deque<Decoded> waiting_;  // decoded, not yet delivered
  int decoded_ = 0, delivered_ = 0;
  double first_stamp_s_ = 0, last_stamp_s_ = 0;
  double time_s_ = 0;
};

}  // namespace softforce::vision
