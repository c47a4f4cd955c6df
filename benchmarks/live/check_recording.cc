// check_recording FOLDER WIDTH HEIGHT RATE_HZ
//
// Plays what was recorded of cameras `left` and `right` that tests/vision/paint_frames painted, and
// prints one line of JSON: whether the pictures of each set carry one number, how many numbers were
// left out, how well the time stamps follow them, and when the last picture was taken.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "softforce/base/input_error.h"
#include "softforce/vision/recording.h"
#include "support/bar_code.h"

namespace {

using softforce::vision::Recording;

softforce::camera::Rig RigOf(int width, int height) {
  softforce::camera::Rig rig;
  for (const char* name : {"left", "right"}) {
    softforce::camera::Camera camera;
    camera.name = name;
    camera.width = width;
    camera.height = height;
    rig.cameras.push_back(camera);
  }
  return rig;
}

int Check(const std::string& folder, int width, int height, double rate) {
  Recording recording(RigOf(width, height),
                      {{"left", folder + "/left"}, {"right", folder + "/right"}});
  int sets = 0, mismatched = 0, unreadable = 0;
  std::vector<double> offsets_s;  // of the time stamps from the painted numbers
  int64_t first = -1, last = -1, left_out = 0;
  while (const auto set = recording.Next()) {
    ++sets;
    const auto left = softforce::testing::ReadNumber(set->pictures[0]);
    const auto right = softforce::testing::ReadNumber(set->pictures[1]);
    if (!left || !right) {
      ++unreadable;
      continue;
    }
    if (*left != *right) ++mismatched;
    if (last >= 0) left_out += *left - last - 1;
    last = *left;
    if (first < 0) first = last;
    offsets_s.push_back(set->time_s - static_cast<double>(last - first) / rate);
  }
  double spread_ms = NAN;
  if (!offsets_s.empty()) {
    const auto [low, high] = std::minmax_element(offsets_s.begin(), offsets_s.end());
    spread_ms = 1e3 * (*high - *low);
  }
  fmt::print(
      "{{\"announced\": {}, \"sets\": {}, \"mismatched\": {}, \"unreadable\": {}, \"left_out\": "
      "{}, "
      "\"first\": {}, \"last\": {}, \"stamp_spread_ms\": {:.3f}, \"truncated\": {}}}\n",
      recording.announced_frames(), sets, mismatched, unreadable, left_out, first, last, spread_ms,
      recording.Report().truncation.empty() ? "false" : "true");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    return Check(argv[1], std::atoi(argv[2]), std::atoi(argv[3]), std::atof(argv[4]));
  } catch (const softforce::base::InputError& error) {
    fmt::print(stderr, "check_recording: {}\n", error.what());
    return 2;
  }
}
