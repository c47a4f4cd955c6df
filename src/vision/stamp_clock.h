#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>

namespace softforce::vision {

// When the pictures of one camera were taken, on this computer's clock, from when they came and
// from the time that the stream gives them. A picture comes late by at least what the camera and
// the way take, and by some jitter, which is never negative.
//
// A stream with time stamps of its own: its clock's offset to ours is the smallest difference seen
// in the last seconds; jitter then does not matter.
//
// A stream without (Motion JPEG over TCP or HTTP) must be of constant rate: pictures are then taken
// at n·period + phase, period by least squares over the last pictures, phase from the earliest one.
// A picture that comes late by half a period or more may be late, or its predecessor may have been
// left out by the camera: it is not sure which, until later ones come in time again (it was late),
// or until all stay late (one was left out).
//
// A stamp is the time at which the picture would have come without jitter. What the way takes at
// least is a constant, which differs between cameras of different kinds: see EstimateTimeOffset().
class StampClock {
 public:
  struct Stamp {
    double time_s = NAN;
    bool sure = false;  // whether it can be relied on to half a period
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
  struct Difference {
    double arrival_s, offset_s;
  };

  void LearnPeriod(double time_s);
  Stamp AddArrival(double arrival_s);
  Stamp Settle(int64_t n, double arrival_s);
  Stamp DecideLeftOut(double arrival_s);
  bool LearnRate();
  double PhaseOf(double period) const;
  void CountGap(double since_last_s);

  double settle_s_;
  double first_arrival_s_ = NAN;
  double last_time_s_ = NAN;
  double period_ = NAN;
  int64_t missed_ = 0;
  std::deque<double> intervals_;         // the last ones, for the median
  std::deque<Difference> least_offset_;  // candidates for the smallest of the window, ascending
  std::deque<Arrival> arrivals_;         // those in time
  std::optional<double> late_since_s_;
  double least_lateness_s_ = NAN;  // since then
  int64_t last_n_ = -1;
  bool settled_ = false, just_left_out_ = false;
};

}  // namespace softforce::vision
