#include "vision/videos_by_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softforce::vision {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

// Files keep nobody waiting: a picture has its partner or will never have one.
Pairer PairerOf(const Videos& videos) { return {videos.size(), kForever, kForever}; }

}  // namespace

VideosByTime::VideosByTime(const Videos& videos, std::vector<double> late_s)
    : videos_(videos),
      late_s_(std::move(late_s)),
      pairer_(PairerOf(videos)),
      read_(videos.size(), 0) {}

void VideosByTime::Rewind() {
  pairer_ = PairerOf(videos_);
  std::fill(read_.begin(), read_.end(), 0);
}

bool VideosByTime::Read(size_t camera) {
  PictureStream& video = *videos_[camera];
  std::optional<cv::Mat> picture = video.Next();
  if (!picture) return false;
  ++read_[camera];
  const double time_s = video.camera_time_s() - late_s_[camera];
  const double period_s = video.period_s() > 0 ? video.period_s() : NAN;
  pairer_.Add(camera, {std::move(*picture), time_s, time_s}, period_s);
  return true;
}

std::optional<FrameSet> VideosByTime::Next() {
  while (true) {
    if (auto pictures = pairer_.Take()) {
      FrameSet set;
      if (!first_s_) first_s_ = pictures->front().time_s;
      set.time_s = pictures->front().time_s - *first_s_;
      for (TimedPicture& picture : *pictures) {
        set.camera_time_s.push_back(picture.time_s - *first_s_);
        set.pictures.push_back(std::move(picture.grey));
      }
      return set;
    }
    for (size_t c = 0; c < videos_.size(); ++c) {
      if (pairer_.waiting(c) > 0 || Read(c)) continue;
      ended_ = c;
      return std::nullopt;
    }
  }
}

int VideosByTime::lag() const {
  const auto [least, most] = std::minmax_element(late_s_.begin(), late_s_.end());
  double period_s = kForever;
  for (const auto& video : videos_) {
    if (video->period_s() > 0) period_s = std::min(period_s, video->period_s());
  }
  return static_cast<int>(std::lround((*most - *least) / period_s));
}

}  // namespace softforce::vision
