#pragma once

#include <optional>
#include <vector>

namespace softforce::vision {

// The rhythm in which events come, of which some come late and some not at all.
struct Rhythm {
  double period_s;
  double phase_s;  // of one that is in time, among the earliest
};

// The period near the median interval for which most of the times agree to a part of it; nothing if
// that is less than 60 % of them. Times ascend.
std::optional<Rhythm> FindRhythm(const std::vector<double>& times_s);

}  // namespace softforce::vision
