#include "vision/recorded_camera.h"

#include <fmt/format.h>

#include <algorithm>

#include "softforce/base/input_error.h"

namespace softforce::vision {

RecordedCamera::RecordedCamera(std::filesystem::path folder)
    : folder_(std::move(folder)),
      times_(ReadTimes(folder_)),
      unfinished_(!IsComplete(folder_ / "..")),
      time_offset_s_(RecordedTimeOffset(folder_)) {
  CheckSegments();
  if (times_.empty()) {
    throw base::InputError(folder_.string(), "holds no whole picture",
                           "The recorder was killed before the first one, or saw none.");
  }
  segment_ = AvReader::OfFile(SegmentFile(folder_, times_.front().segment).string());
  if (segment_ == nullptr) {
    throw base::InputError(SegmentFile(folder_, times_.front().segment).string(),
                           "is no video that can be decoded", "Put it back as it was recorded.");
  }
  size_ = segment_->size();
}

// The power may have failed before the last segment was on the disk; all others were synced.
void RecordedCamera::CheckSegments() {
  size_t from = 0;
  while (from < times_.size()) {
    const int segment = times_[from].segment;
    size_t to = from;
    while (to < times_.size() && times_[to].segment == segment) ++to;
    const bool may_be_cut = unfinished_ && to == times_.size();
    const std::filesystem::path file = SegmentFile(folder_, segment);
    const bool exists = std::filesystem::is_regular_file(file);
    if (!exists && !may_be_cut) {
      throw base::InputError(file.string(), "this part of the recording is missing",
                             "Put it back: pictures are told apart by their order.");
    }
    if (may_be_cut) {
      const size_t whole = exists ? static_cast<size_t>(CountPictures(file.string())) : 0;
      times_.resize(from + std::min(whole, to - from));
    }
    from = to;
  }
}

std::optional<cv::Mat> RecordedCamera::Next() {
  if (next_ == times_.size()) return std::nullopt;
  const RecordedTime& time = times_[next_];
  if (segment_ == nullptr || (next_ > 0 && times_[next_ - 1].segment != time.segment)) {
    segment_ = AvReader::OfFile(SegmentFile(folder_, time.segment).string());
  }
  if (segment_ == nullptr) return std::nullopt;
  auto picture = segment_->Next();
  if (!picture) return std::nullopt;  // damaged: the recording counts as cut off here
  last_ = time;
  ++next_;
  return picture->grey;
}

// The median: sets are missing here and there.
double RecordedCamera::period_s() const {
  std::vector<double> intervals;
  for (size_t i = 1; i < times_.size(); ++i) {
    intervals.push_back(times_[i].camera_time_s - times_[i - 1].camera_time_s);
  }
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return std::max(0.0, *middle);
}

void RecordedCamera::Rewind() {
  next_ = 0;
  last_ = {};
  segment_.reset();
}

}  // namespace softforce::vision
