#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
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

// Why a device cannot be a camera, as far as that shows before it is used; empty: it can.
std::string WhyNoCamera(const std::string& device) {
  const int file = open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {
    if (errno == ENOENT) return fmt::format("there is no device {}", device);
    if (errno == EACCES || errno == EPERM) {
      return fmt::format("there is no permission to use {}; its group is mostly \"video\"", device);
    }
    if (errno == EBUSY) return fmt::format("{} is in use by another program", device);
    return fmt::format("{}: {}", device, std::strerror(errno));
  }
  v4l2_capability capability{};
  const bool answers = ioctl(file, VIDIOC_QUERYCAP, &capability) == 0;
  close(file);
  if (!answers) return fmt::format("{} is no camera (V4L2)", device);
  const bool own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const uint32_t can = own ? capability.device_caps : capability.capabilities;
  if ((can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0) return "";
  return fmt::format("{} gives no pictures; many cameras have a second device beside it that does",
                     device);
}

}  // namespace

OpenedStream OpenDevice(const LiveCamera& camera, const LiveOptions& options, Patience* patience,
                        std::string* problem) {
  // OpenCV waits so long for a picture, ten seconds unless told otherwise.
  setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT",
         fmt::format("{}", std::max(1, static_cast<int>(options.stall_s))).c_str(), 0);
  const std::string device =
      camera.source.rfind("/dev/", 0) == 0 ? camera.source : "/dev/video" + camera.source;
  *problem = WhyNoCamera(device);
  if (!problem->empty()) return nullptr;
  cv::VideoCapture capture;
  if (!capture.open(device, cv::CAP_V4L2)) {
    *problem =
        fmt::format("{} is in use by another program, or has no format that can be read", device);
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
  const cv::Size size(static_cast<int>(capture.get(cv::CAP_PROP_FRAME_WIDTH)),
                      static_cast<int>(capture.get(cv::CAP_PROP_FRAME_HEIGHT)));
  if (!camera.size.empty() && size != camera.size) {
    *problem = fmt::format(
        "{} does not give pictures of {}x{} px, but of {}x{} px; see v4l2-ctl -d {} "
        "--list-formats-ext, and --pixel-format",
        device, camera.size.width, camera.size.height, size.width, size.height, device);
    return nullptr;
  }
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
