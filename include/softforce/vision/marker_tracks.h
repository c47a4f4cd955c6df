#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/time_offset.h"

namespace softforce::vision {

// A marker that one camera followed from picture to picture.
using Track = std::vector<TimedPixel>;

// Follows spots without names through one camera's pictures: each is looked for where its last two
// pictures let it be expected, and no further from there than two fifths of the way to the next
// spot, so that neighbours are not taken for each other. What cannot be told ends a track.
class SpotFollower {
 public:
  // `longest_gap_s`: a spot that is not seen for so long is another one when it comes back.
  explicit SpotFollower(double longest_gap_s = 0.1) : longest_gap_s_(longest_gap_s) {}

  // The spots of the next picture, px; times ascend.
  void Add(double time_s, const std::vector<Eigen::Vector2d>& spots);

  // Those of at least so many pictures.
  std::vector<Track> Tracks(size_t fewest = 20) const;

 private:
  double longest_gap_s_;
  std::vector<Track> live_, ended_;
};

// Which track of one camera is of the same marker as which of another: the two stay on each other's
// epipolar lines, best with an offset between the cameras' clocks that is common to all. A track
// that could belong to several is given to the one that it fits best, if that one has no better.
// Markers side by side that move alike may be taken for each other; for the offset that is as good.
std::vector<TrackPair> PairTracks(const camera::Rig& rig, int first, int second,
                                  const std::vector<Track>& in_first,
                                  const std::vector<Track>& in_second,
                                  const TimeOffsetOptions& options = {});

}  // namespace softforce::vision
