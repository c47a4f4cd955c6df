#include "softforce/vision/video_writer.h"

#include <optional>

#include "softforce/base/pending_file.h"
#include "vision/h264_encoder.h"

namespace softforce::vision {
namespace {

H264Encoder::Settings SettingsFor(const cv::Mat& picture, double frames_per_second,
                                  VideoQuality quality) {
  const bool measuring = quality == VideoQuality::kMeasuring;
  return {picture.size(),      frames_per_second, picture.channels() == 1,
          measuring ? 12 : 23, measuring,         !measuring};
}

}  // namespace

struct VideoWriter::State {
  base::PendingFile file;
  double frames_per_second;
  VideoQuality quality;
  std::optional<H264Encoder> encoder;
};

VideoWriter::VideoWriter(const std::filesystem::path& path, double frames_per_second,
                         VideoQuality quality)
    : state_(new State{base::PendingFile(path), frames_per_second, quality, {}}) {}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;

void VideoWriter::Add(const cv::Mat& picture) {
  // H.264 stores colour for blocks of 2×2 pixels.
  const cv::Mat even = picture(cv::Rect(0, 0, picture.cols & ~1, picture.rows & ~1));
  if (!state_->encoder) {
    state_->encoder.emplace(state_->file.temporary(),
                            SettingsFor(even, state_->frames_per_second, state_->quality));
  }
  state_->encoder->Add(even);
}

void VideoWriter::Commit() {
  if (!state_->encoder) return;  // no picture, no file
  state_->encoder->Finish();
  state_->encoder.reset();
  state_->file.Commit();
}

}  // namespace softforce::vision
