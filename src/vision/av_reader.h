#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "vision/libav.h"

namespace softforce::vision {

// Decodes the first video of a container (a file or a stream) picture by picture, each as soon as
// it can be.
class AvReader {
 public:
  struct Picture {
    cv::Mat grey;                    // CV_8UC1, all 256 levels used
    std::optional<double> stream_s;  // the container's time; nothing where it has none of its own
  };

  // Takes a container that avformat_open_input() opened; null if it holds no video.
  static std::unique_ptr<AvReader> Of(AvOwned<AVFormatContext> container);
  static std::unique_ptr<AvReader> OfFile(const std::string& file);
  ~AvReader();

  std::optional<Picture> Next();  // nothing at the end, or where it was interrupted
  cv::Size size() const;          // px

 private:
  AvReader();
  std::optional<Picture> Receive();

  struct State;
  std::unique_ptr<State> state_;
};

// How many whole pictures a file holds; 0 if it cannot be read. Nothing is decoded.
int CountPictures(const std::string& file);

}  // namespace softforce::vision
