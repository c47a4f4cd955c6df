#include "softforce/vision/time_offset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softforce/base/input_error.h"
#include "vision/epipolar_misfits.h"

namespace softforce::vision {
namespace {

constexpr int kFewestPictures = 20;
constexpr int kFewestTracks = 5;
constexpr int kGrid = 40;  // steps of the search to either side

// The offset nearby that fits best, by Gauss-Newton.
double Refine(const EpipolarMisfits& problem, double offset_s, double longest_s) {
  for (int iteration = 0; iteration < 20; ++iteration) {
    const EpipolarMisfits::Sum sum = problem.Evaluate(offset_s);
    if (!(sum.normal > 0)) break;
    const double largest = longest_s / kGrid;  // the minimum is nearer
    const double step = std::clamp(sum.right / sum.normal, -largest, largest);
    offset_s = std::clamp(offset_s + step, -longest_s, longest_s);
    if (std::abs(step) < 1e-9) break;
  }
  return offset_s;
}

}  // namespace

void TimeOffsetOptions::Check() const {
  const auto require = [](bool holds, const char* option) {
    if (!holds) throw base::InputError(std::string("time offset: ") + option, "must be positive");
  };
  require(longest_s > 0, "longest_s");
  require(longest_gap_s > 0, "longest_gap_s");
  require(robust_px > 0, "robust_px");
  require(largest_sd_s > 0, "largest_sd_s");
}

std::string TimeOffset::BriefReport() const {
  switch (status) {
    case Status::kNotRun:
      return "not estimated";
    case Status::kTooFewPictures:
      return fmt::format("too few pictures of markers in both cameras ({})", used);
    case Status::kAtLimit:
      return fmt::format("no minimum: the best is {:.1f} ms, where the search ends",
                         1e3 * offset_s);
    case Status::kTooLittleMotion:
      return fmt::format("too little motion across the epipolar lines: {:.2f} ± {:.2f} ms",
                         1e3 * offset_s, 1e3 * sd_s);
    case Status::kOk:
      break;
  }
  return fmt::format("{:.2f} ± {:.2f} ms, {:.2f} px are left, {} pictures", 1e3 * offset_s,
                     1e3 * sd_s, rms_px, used);
}

TimeOffset EstimateTimeOffset(const camera::Rig& rig, int first, int second,
                              const std::vector<TrackPair>& tracks,
                              const TimeOffsetOptions& options) {
  options.Check();
  EpipolarMisfits problem(rig.cameras.at(static_cast<size_t>(first)),
                          rig.cameras.at(static_cast<size_t>(second)), tracks, options);
  TimeOffset result;
  double best = INFINITY;
  for (int i = -kGrid; i <= kGrid; ++i) {
    const double offset = options.longest_s * i / kGrid;
    const EpipolarMisfits::Sum sum = problem.Evaluate(offset);
    if (sum.used < kFewestPictures || sum.mean_cost() >= best) continue;
    best = sum.mean_cost();
    result.offset_s = offset;
  }
  if (std::isinf(best)) {
    result.used = problem.Evaluate(0).used;
    result.status = TimeOffset::Status::kTooFewPictures;
    return result;
  }
  result.offset_s = Refine(problem, result.offset_s, options.longest_s);
  problem.TightenLimit(result.offset_s);
  result.offset_s = Refine(problem, result.offset_s, options.longest_s);
  const EpipolarMisfits::Sum sum = problem.Evaluate(result.offset_s);
  result.used = sum.used;
  result.rms_px = std::sqrt(sum.squares / sum.used);
  const double noise = std::sqrt(sum.squares / sum.noise_squares);  // px, of a marker in a picture
  // Markers that stand still seem to move by their noise.
  const double from_noise = noise * noise * sum.noise_normal;
  const double from_motion = sum.normal - from_noise;
  // Errors of finding markers follow one another; of different markers they do not. So the spread
  // over the tracks counts, if there are enough to tell, where it is larger.
  const double spread = sum.tracks >= kFewestTracks
                            ? sum.right_squares * sum.tracks / static_cast<double>(sum.tracks - 1)
                            : 0;
  const double variance = std::max(noise * noise * sum.variance, spread);
  result.sd_s = from_motion > 0 ? std::sqrt(variance) / from_motion : INFINITY;
  if (std::abs(result.offset_s) >= options.longest_s * (1 - 1e-9)) {
    result.status = TimeOffset::Status::kAtLimit;
  } else if (!(result.sd_s <= options.largest_sd_s) || from_motion < from_noise) {
    result.status = TimeOffset::Status::kTooLittleMotion;
  } else {
    result.status = TimeOffset::Status::kOk;
  }
  return result;
}

}  // namespace softforce::vision
