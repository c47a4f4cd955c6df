#include "vision/video_file.h"

#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "softforce/base/input_error.h"

namespace softforce::vision {

namespace {

// Matroska files that were never closed, for one, do not say how long they are: OpenCV then gives
// nonsense.
int AnnouncedBy(const cv::VideoCapture& capture) {
  const double count = capture.get(cv::CAP_PROP_FRAME_COUNT);
  return count >= 1 && count < 1e9 ? static_cast<int>(std::lround(count)) : 0;
}

}  // namespace

VideoFile::VideoFile(std::filesystem::path file, const std::vector<std::filesystem::path>& siblings)
    : file_(std::move(file)) {
  // FFmpeg writes to standard error through OpenCV unless told otherwise; damaged files are
  // reported here.
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  if (!std::filesystem::is_regular_file(file_)) {
    throw base::InputError(
        file_.string(), "there is no such video file",
        "Check 'sources' in the scene, or give the file with --camera NAME=FILE.");
  }
  if (!Open()) {
    for (const std::filesystem::path& sibling : siblings) {
      salvaged_ = SalvageMp4(file_, sibling);
      if (salvaged_ && Open()) break;
    }
  }
  if (!capture_.isOpened()) {
    const bool cut = IsMp4WithoutIndex(file_);
    throw base::InputError(
        file_.string(),
        cut ? "the video was cut off: its index (moov), which is written last, is missing"
            : "is no video that can be decoded",
        cut ? "Copy or record it again; or put the other cameras' complete files beside it, from "
              "which it "
              "can be decoded up to the cut."
            : "Play it with ffplay to see what is wrong; MP4 (H.264), MKV and AVI work.");
  }
  size_ = {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
           static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
  frames_per_second_ = salvaged_ ? salvaged_->frames_per_second() : capture_.get(cv::CAP_PROP_FPS);
  announced_ = salvaged_ ? salvaged_->announced_frames() : AnnouncedBy(capture_);
}

bool VideoFile::Open() {
  const std::filesystem::path& source = salvaged_ ? salvaged_->file() : file_;
  return capture_.open(source.string(), cv::CAP_FFMPEG);
}

std::optional<VideoFile::Decoded> VideoFile::Decode() {
  cv::Mat picture;
  if (!capture_.grab() || !capture_.retrieve(picture) || picture.empty()) return std::nullopt;
  Decoded decoded;
  const double stamp_s = 1e-3 * capture_.get(cv::CAP_PROP_POS_MSEC);
  if (decoded_ == 0) first_stamp_s_ = stamp_s;
  if (!salvaged_ && (decoded_ == 0 || stamp_s > last_stamp_s_)) {
    decoded.stamp_s = stamp_s - first_stamp_s_;
    last_stamp_s_ = stamp_s;
  }
  ++decoded_;
  if (picture.channels() == 1) {
    decoded.grey = picture.clone();
  } else {
    cv::cvtColor(picture, decoded.grey, cv::COLOR_BGR2GRAY);
  }
  return decoded;
}

// OpenCV 4.6 loses the stamps of the pictures that the decoder holds back until the file ends,
// because others could come before them. Where a file was cut off, others should have: they cannot
// be told from their successors.
void VideoFile::DecodeTail(Decoded first) {
  constexpr size_t kLongestTail = 64;  // pictures; a container with no stamps at all has more
  waiting_.push_back(std::move(first));
  while (waiting_.size() < kLongestTail && !waiting_.back().stamp_s) {
    std::optional<Decoded> next = Decode();
    if (!next) {
      const bool ended_early = delivered_ + static_cast<int>(waiting_.size()) < announced_;
      if (ended_early || announced_ == 0) waiting_.clear();
      return;
    }
    waiting_.push_back(std::move(*next));
  }
}

std::optional<cv::Mat> VideoFile::Next() {
  if (salvaged_ && delivered_ == salvaged_->whole_frames()) return std::nullopt;
  if (waiting_.empty()) {
    std::optional<Decoded> decoded = Decode();
    if (!decoded) return std::nullopt;
    if (decoded->stamp_s || salvaged_) {
      waiting_.push_back(std::move(*decoded));
    } else {
      DecodeTail(std::move(*decoded));
      if (waiting_.empty()) return std::nullopt;
    }
  }
  const Decoded next = std::move(waiting_.front());
  waiting_.pop_front();
  time_s_ = next.stamp_s.value_or(delivered_ / frames_per_second_);
  ++delivered_;
  return next.grey;
}

void VideoFile::Rewind() {
  capture_.release();
  Open();
  waiting_.clear();
  decoded_ = 0;
  delivered_ = 0;
  time_s_ = 0;
}

}  // namespace softforce::vision
