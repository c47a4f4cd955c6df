#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace softforce::vision {

// To look at, or to measure in: there H.264 gets so many bits that the centres of dots and the
// corners of tags move by less than 0.02 px.
enum class VideoQuality { kViewing, kMeasuring };

// Writes an MP4 (H.264) that plays in browsers. The file shows up under its name only once it is
// complete.
class VideoWriter {
 public:
  // Pictures must all be of one size and kind; the first one sets them. Throws InputError if the
  // file cannot be made.
  VideoWriter(const std::filesystem::path& path, double frames_per_second,
              VideoQuality quality = VideoQuality::kViewing);
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;

  void Add(const cv::Mat& picture);  // 8 bits, BGR or grey; odd sides are trimmed by a pixel
  void Commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
