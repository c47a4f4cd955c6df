#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "vision/camera_stream.h"

namespace softforce::vision {
namespace {

// A V4L2 device through OpenCV, which converts what cameras send. The driver stamps each picture
// when it arrives in the computer.
class DeviceStream : public CameraStream {
 public:
  DeviceStream(cv::VideoCapture capture, Patience* patience)
      : capture_(std::move(capture)), patience_(patience) {}

  std::optional<Grabbed> Grab() override {
    if (patience_->stopped()) return std::nullopt;
    Grabbed grabbed;
    if (!capture_.grab()) {
      problem_ = "the device gives no picture";
      return std::nullopt;
    }
    grabbed.arrival_s = MonotonicNow();
    grabbed.stream_s = 1e-3 * capture_.get(cv::CAP_PROP_POS_MSEC);
    // Some drivers stamp by another clock, or not at all.
    const double age_s = grabbed.arrival_s - *grabbed.stream_s;
    grabbed.exact = age_s >= 0 && age_s < 1;
    if (!(*grabbed.stream_s > 0)) grabbed.stream_s.reset();
    cv::Mat picture;
    if (!capture_.retrieve(picture) || picture.empty()) {
      problem_ = "a picture of the device cannot be decoded";
      return std::nullopt;
    }
    if (picture.channels() == 1) {
      grabbed.grey = picture.clone();
    } else {
      cv::cvtColor(picture, grabbed.grey, cv::COLOR_BGR2GRAY);
    }
    return grabbed;
  }

 private:
  cv::VideoCapture capture_;
  Patience* patience_;
};

}  // namespace

OpenedStream OpenDevice(const LiveCamera& camera, const LiveOptions& options, Patience* patience,
                        std::string* problem) {
  // OpenCV waits so long for a picture, ten seconds unless told otherwise.
  setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT",
         fmt::format("{}", std::max(1, static_cast<int>(options.stall_s))).c_str(), 0);
  const std::string device =
      camera.source.rfind("/dev/", 0) == 0 ? camera.source : "/dev/video" + camera.source;
  std::error_code ignored;
  if (!std::filesystem::exists(device, ignored)) {
    *problem = fmt::format("there is no device {}", device);
    return nullptr;
  }
  cv::VideoCapture capture;
  if (!capture.open(device, cv::CAP_V4L2)) {
    *problem = fmt::format(
        "the device {} cannot be opened: in use, no permission (group video), "
        "or no camera",
        device);
    return nullptr;
  }
  if (options.pixel_format.size() == 4) {
    const std::string& f = options.pixel_format;
    capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc(f[0], f[1], f[2], f[3]));
  }
  if (!camera.size.empty()) {
    capture.set(cv::CAP_PROP_FRAME_WIDTH, camera.size.width);
    capture.set(cv::CAP_PROP_FRAME_HEIGHT, camera.size.height);
  }
  if (options.rate_hz > 0) capture.set(cv::CAP_PROP_FPS, options.rate_hz);
  return std::make_unique<DeviceStream>(std::move(capture), patience);
}

OpenedStream OpenStream(const LiveCamera& camera, const LiveOptions& options, Patience* patience,
                        std::string* problem) {
  switch (KindOf(camera.source)) {
    case SourceKind::kDevice:
      return OpenDevice(camera, options, patience, problem);
    case SourceKind::kPipeline:
      return OpenPipeline(camera, patience, problem);
    case SourceKind::kUrl:
      return OpenUrl(camera, patience, problem);
    case SourceKind::kFile:
      break;
  }
  *problem = "is a file, not a live camera";
  return nullptr;
}

}  // namespace softforce::vision
