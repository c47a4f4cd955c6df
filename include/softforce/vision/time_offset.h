#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"

namespace softforce::vision {

// Where one camera saw a marker, by its own time stamps.
struct TimedPixel {
  double time_s = NAN;
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(NAN);  // px, distorted
};

// The track of one marker in two cameras; times ascend in each.
struct TrackPair {
  std::vector<TimedPixel> in_first, in_second;
};

struct TimeOffsetOptions {
  double longest_s = 0.1;      // the offset is looked for within ± this
  double longest_gap_s = 0.1;  // between pictures; tracks are not interpolated over longer ones
  double robust_px = 2;        // misfits beyond this do not count
  double largest_sd_s = 2e-3;  // an offset less certain is not ok()

  void Check() const;  // throws InputError naming the option
};

struct TimeOffset {
  enum class Status {
    kNotRun,
    kOk,
    kTooFewPictures,   // of markers seen by both cameras at one time
    kTooLittleMotion,  // the markers hardly move across the epipolar lines: `sd_s` is too large
    kAtLimit           // the best offset is at the border of what was searched
  };

  Status status = Status::kNotRun;
  // By how much the second camera's stamps are later than the first one's for the same moment: what
  // LiveCamera::time_offset_s takes.
  double offset_s = NAN;
  double sd_s = NAN;    // standard deviation, from the misfit that is left
  double rms_px = NAN;  // of that misfit, per picture of a marker, across the epipolar line
  int used = 0;         // pictures of markers, which count

  bool ok() const { return status == Status::kOk; }
  std::string BriefReport() const;  // one line
};

// The constant offset between two cameras' time stamps from markers that move: the second camera's
// tracks are interpolated (in the picture, by cubics) to the first one's times less the offset, and
// the sum of squared distances to the epipolar lines is made least over the offset, robustly, from
// the best of a grid. Each track may be off the lines by a constant, and by a share of its way, of
// its own, since cameras are calibrated to some tenths of a pixel only, which a motion that goes
// one way could not tell from an offset. Only motion across the epipolar lines that changes its
// speed tells anything: for cameras side by side, up and down, to and fro. Too little of it is an
// answer, not an error: read `status`.
TimeOffset EstimateTimeOffset(const camera::Rig& rig, int first, int second,
                              const std::vector<TrackPair>& tracks,
                              const TimeOffsetOptions& options = {});

}  // namespace softforce::vision
