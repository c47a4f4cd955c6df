#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace softforce::vision {

// An MP4 with H.264, or with MPEG-4 where FFmpeg was built without H.264, by FFmpeg's own
// libraries: OpenCV's writer does not let the quality be chosen. The same pictures give the same
// bytes on one machine.
class H264Encoder {
 public:
  struct Settings {
    cv::Size size;  // even
    double frames_per_second = 30;
    bool grey = false;
    int crf = 23;  // x264's constant rate factor: 0 (nothing is lost) to 51
    // x264 spends its bits to please the eye, on flat and noisy ground. Without that, edges come
    // out as well with a third of the bits.
    bool edges_first = false;
    bool quick = false;  // half the time, half as large again
  };

  // Throws InputError if the file cannot be made.
  H264Encoder(const std::filesystem::path& file, const Settings& settings);
  ~H264Encoder();

  void Add(const cv::Mat& picture);  // CV_8UC1 or BGR of the size set
  void Finish();                     // throws InputError if the file could not be completed

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
