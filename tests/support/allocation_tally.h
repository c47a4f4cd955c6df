#pragma once

#include <algorithm>
#include <cmath>

namespace softforce::testing {

enum class Hiding {
  kEachFrame,  // other markers in each frame
  kBursts,     // the same ones for 10 to 20 frames
  kSide        // the same, all of them on one side of the sheet
};

// What happens to the markers in a run of frames.
struct Disturbance {
  double hidden = 0;  // share of the markers that no camera sees
  Hiding hiding = Hiding::kEachFrame;
  double clutter = 0;       // false dots, as a share of the markers seen
  int blackout_every = 0;   // frames; at the end of them no camera sees anything
  int blackout_length = 5;  // frames
  // Clutter is up to this many times larger or smaller than a marker.
  double clutter_sizes = 1;
};

// What came of the markers, counted per marker and frame.
struct AllocationTally {
  int frames = 0, lost_frames = 0;
  int shown = 0;                     // seen by a camera
  int right = 0;                     // shown, and used with their own dots
  int swapped = 0;                   // used with another marker's dot, and not flagged
  int clutter_taken = 0;             // used with clutter, and not flagged
  int flagged_wrong = 0;             // with a wrong dot, but rejected
  int left_out = 0;                  // shown, but said to be hidden or rejected
  int hidden = 0, hidden_right = 0;  // not shown; and said to be hidden
  int returns = 0, returned_at_once = 0, returned_next = 0;
  int regions = 0, covered = 0;  // hidden markers' 95 % regions; that hold the truth
  double region_sd = 0;          // m, sum of the regions' standard deviations (of one axis)
  double region_error2 = 0;      // m², sum of the squared errors in them (of one axis)
  double clutter_distance2 = 0;  // px², sum over clutter taken, to where the marker really was
  double force_error2 = 0, motion = 0, fastest = 0, seconds = 0;  // N², m, m, s; sums but `fastest`
  // N², sums of what an exact model would leave for noise and the rig's place, had all markers been
  // seen and as they were; and of what the tracker reports.
  double least_variance_all = 0, least_variance = 0, reported_variance = 0;
  int after_blackout = 0, recovered = 0;  // blackouts; forces back in the first frame after

  double RightShare() const {
    return static_cast<double>(right + hidden_right) / static_cast<double>(shown + hidden);
  }
  double ForceError() const { return RootMean(force_error2); }               // N
  double LeastForceSd() const { return RootMean(least_variance); }           // N
  double LeastForceSdOfAll() const { return RootMean(least_variance_all); }  // N
  double ReportedForceSd() const { return RootMean(reported_variance); }     // N
  double RootMean(double sum) const { return std::sqrt(sum / std::max(1, frames - lost_frames)); }
};

}  // namespace softforce::testing
