#include "softforce/vision/video_writer.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::vision {

struct VideoWriter::State {
  base::PendingFile file;
  double frames_per_second;
  cv::VideoWriter writer;

  void Open(const cv::Size& size) {
    for (const char* code : {"avc1", "mp4v"}) {  // H.264 where OpenCV was built with it
      writer.open(file.temporary().string(), cv::CAP_FFMPEG,
                  cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), frames_per_second,
                  size);
      if (writer.isOpened()) return;
    }
    throw base::InputError(file.path().string(), "the video cannot be written",
                           "Check the folder's permissions and the disk's space, or leave it out.");
  }
};

VideoWriter::VideoWriter(const std::filesystem::path& path, double frames_per_second)
    : state_(new State{base::PendingFile(path), frames_per_second, {}}) {}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;

void VideoWriter::Add(const cv::Mat& bgr) {
  // H.264 stores colour for blocks of 2×2 pixels.
  const cv::Mat even = bgr(cv::Rect(0, 0, bgr.cols & ~1, bgr.rows & ~1));
  if (!state_->writer.isOpened()) state_->Open(even.size());
  state_->writer.write(even);
}

void VideoWriter::Commit() {
  if (!state_->writer.isOpened()) return;  // no picture, no file
  state_->writer.release();
  state_->file.Commit();
}

}  // namespace softforce::vision
