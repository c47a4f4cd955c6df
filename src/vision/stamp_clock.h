#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>

#include "vision/rhythm.h"

namespace softforce::vision {

// When the pictures of one camera were taken, on this computer's clock, from when they came and
// from the time that the stream gives them. A picture comes late by at least what the camera and
// the way take, and by some jitter, which is never negative.
//
// A stream with time stamps of its own: its clock's offset to ours is the smallest difference seen,
// which may grow by what clocks drift, once several pictures came near it. Jitter then does not
// matter, nor does a computer that is busy for a while.
//
// A stream without (Motion JPEG over TCP or HTTP) must be of constant rate: its pictures are taken
// at phase + n·period. The period is the one in whose rhythm most pictures came, then that of a
// least-squares line through those that came in time; the phase is that of the earliest. What is
// left is to tell each picture's n. It is at least one more than that of the picture before, and no
// more than its arrival allows. If only one number is left it is that; else the picture may be late
// or its predecessors may have been left out by the camera, and it is not sure which, until the
// pictures come in the rhythm again: then none of them waits anywhere.
//
// A stamp is the time at which the picture would have come without jitter. What the way takes at
// least is a constant, which differs between cameras of different kinds: see EstimateTimeOffset().
class StampClock {
 public:
  struct Stamp {
    double time_s = NAN;
    bool sure = false;  // whether it is good for pairing
  };

  // Nothing is sure in the first `settle_s` seconds.
  explicit StampClock(double settle_s) : settle_s_(settle_s) {}

  // `stream_s`: the stream's time, if it has one.
  Stamp Add(double arrival_s, std::optional<double> stream_s);

  // A stamp of this computer's own clock, as V4L2 drivers give: sure as soon as the period is
  // known.
  Stamp AddExact(double time_s);

  void Restart();                              // the camera was opened again
  double period_s() const { return period_; }  // between two pictures; NaN until it is known
  int64_t missed() const { return missed_; }   // left out by the camera, as gaps show

 private:
  // The n-th picture of the stream (pictures left out count), and when it came.
  struct Arrival {
    int64_t n;
    double time_s;
  };

  void LearnPeriod(double time_s);
  Stamp AddArrival(double arrival_s);
  std::optional<Rhythm> RecentRhythm() const;
  void Settle(const Rhythm& rhythm);
  void InTime(int64_t n, double arrival_s);

  double settle_s_;
  int64_t missed_ = 0;
  double first_arrival_s_ = NAN;
  double period_ = NAN;
  // Of streams with times:
  double last_time_s_ = NAN;
  std::deque<double> intervals_;  // the last ones, for the median
  double least_offset_s_ = NAN;   // of our clock to the stream's
  int support_ = 0;               // pictures that came near it
  // Of streams without:
  std::deque<double> recent_s_;   // arrivals
  std::deque<Arrival> arrivals_;  // those in time
  bool settled_ = false;
  double phase_ = NAN;   // when picture 0 would have come
  int64_t least_n_ = 0;  // that the last picture can have had
  int in_rhythm_ = 0;    // pictures, up to the last one
  double last_sure_s_ = NAN, last_early_s_ = NAN;
};

}  // namespace softforce::vision
