#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace softforce::vision {

// Writes an MP4 (H.264) that plays in browsers. The file shows up under its name only once it is
// complete.
class VideoWriter {
 public:
  // Pictures must all be of one size; the first one sets it. Throws InputError if the file cannot
  // be made.
  VideoWriter(const std::filesystem::path& path, double frames_per_second);
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;

  void Add(const cv::Mat& bgr);
  void Commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
