#pragma once

#include <string>
#include <vector>

#include "softforce/vision/board_detector.h"

namespace softforce::vision {

struct ChooseOptions {
  double max_blur = 0.15;       // blur of edges (standard deviation) over the picture of a cell
  double max_blur_ratio = 1.6;  // the same over that of the camera's sharper views
  double min_motion = 0.25;     // mean motion of the points against every kept set, in cells
  double max_speed = 0.1;       // live: mean motion of the points since the moment before, in cells
  int max_sets = 0;             // keep the most different ones only; 0: all

  void Check() const;  // throws InputError naming the option
};

// Whether one camera's view of one moment takes part.
struct ViewVerdict {
  enum class Status { kKept, kNoBoard, kBlurred, kMoving, kDuplicate, kSurplus };

  Status status = Status::kNoBoard;
  std::string reason;  // for a person; empty if kept

  bool kept() const { return status == Status::kKept; }
};

// Leaves out views in which the board was not found or is blurred against its size or against other
// views of the same camera, then moments that show what another, sharper one shows already: of a
// video of a board that rests for a second, one frame. `sets[i][c]` is what camera c saw at moment
// i; the answer has the same shape. A moment that shows a camera or points that the other
// does not is never alike. The same detections give the same choice.
std::vector<std::vector<ViewVerdict>> ChooseViews(
    const std::vector<std::vector<BoardDetection>>& sets, const ChooseOptions& options = {});

// The same, moment by moment as they come, for live guidance: what is kept stays kept. Moments in
// which the board still moves are left out too, so that cameras need not expose at the same
// instant. Blur is judged against the views so far.
class ViewChooser {
 public:
  explicit ViewChooser(const ChooseOptions& options = {});  // max_sets is not used

  // What each camera saw at the next moment: whether it takes part.
  std::vector<ViewVerdict> Add(const std::vector<BoardDetection>& set);

  const std::vector<std::vector<BoardDetection>>& kept() const { return kept_; }

 private:
  ChooseOptions options_;
  std::vector<BoardDetection> before_;             // the moment before
  std::vector<std::vector<double>> blurs_;         // px, of each camera's views so far
  std::vector<std::vector<BoardDetection>> kept_;  // views left out are empty
  std::vector<int> moments_;                       // of the kept ones
  int moment_ = -1;
};

}  // namespace softforce::vision
