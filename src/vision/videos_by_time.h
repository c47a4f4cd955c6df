#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "softforce/vision/frame_source.h"
#include "vision/pairer.h"
#include "vision/picture_stream.h"

namespace softforce::vision {

using Videos = std::vector<std::unique_ptr<PictureStream>>;

// Puts pictures of videos together by when they were taken instead of by their number. What has no
// partner within half a period is left out.
class VideosByTime {
 public:
  // `late_s`: by how much the times of each video are late. The videos must outlive it.
  VideosByTime(const Videos& videos, std::vector<double> late_s);

  // The next set, its times counted from the first one's; nothing where a video has ended.
  std::optional<FrameSet> Next();

  void Rewind();  // the videos were

  // How many sets fewer than pictures there are, if none is missing.
  int lag() const;

  // The video that has no more pictures, after Next() gave nothing; and how many it gave.
  const PictureStream& ended() const { return *videos_[ended_]; }
  int pictures_of_ended() const { return read_[ended_]; }

 private:
  bool Read(size_t camera);

  const Videos& videos_;
  const std::vector<double> late_s_;
  Pairer pairer_;
  std::vector<int> read_;
  std::optional<double> first_s_;
  size_t ended_ = 0;
};

}  // namespace softforce::vision
