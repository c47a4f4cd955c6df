#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

namespace softforce::vision {

// The stored pictures of one camera, one after another.
class PictureStream {
 public:
  virtual ~PictureStream() = default;

  virtual const std::filesystem::path& file() const = 0;
  virtual cv::Size size() const = 0;          // px
  virtual int announced_frames() const = 0;   // 0 if the file does not say
  virtual std::optional<cv::Mat> Next() = 0;  // 8-bit grey; nothing at the end
  virtual double time_s() const = 0;          // of the last picture's set
  virtual double camera_time_s() const = 0;   // of the last picture itself
  virtual void Rewind() = 0;

  // s, between two pictures; 0 if that is not known.
  virtual double period_s() const = 0;

  // s, by which `camera_time_s` was already corrected when it was recorded.
  virtual double time_offset_s() const { return 0; }

  // Whether another camera's pictures may be one more or fewer: the recorder of both was killed.
  virtual bool unfinished() const { return false; }
};

}  // namespace softforce::vision
