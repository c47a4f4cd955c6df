#include "softforce/vision/time_offset.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <optional>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

constexpr int kFewestPictures = 20;

// The epipolar form x2ᵀ E x1 of two undistorted points, and its gradient by their pixels.
struct Form {
  double value;
  Eigen::Vector2d by_first, by_second;  // 1/px
};

// A value of a track between its pictures: a cubic through four of them.
struct Interpolated {
  size_t from;  // first of the four
  std::array<double, 4> weights, slopes;
  Eigen::Vector2d pixel, velocity;  // px, px/s
};

std::optional<Interpolated> Interpolate(const std::vector<TimedPixel>& track, double time_s,
                                        double longest_gap_s) {
  const auto after = std::upper_bound(track.begin(), track.end(), time_s,
                                      [](double t, const TimedPixel& p) { return t < p.time_s; });
  const auto index = after - track.begin();
  if (index < 2 || index + 2 > static_cast<std::ptrdiff_t>(track.size())) return std::nullopt;
  Interpolated at{static_cast<size_t>(index - 2), {}, {}, {0, 0}, {0, 0}};
  const TimedPixel* p = &track[at.from];
  for (int i = 0; i < 3; ++i) {
    if (p[i + 1].time_s - p[i].time_s > longest_gap_s) return std::nullopt;
  }
  for (int i = 0; i < 4; ++i) {  // Lagrange's polynomials and their derivatives
    double denominator = 1, weight = 1, slope = 0;
    for (int j = 0; j < 4; ++j) {
      if (j == i) continue;
      denominator *= p[i].time_s - p[j].time_s;
      slope = slope * (time_s - p[j].time_s) + weight;
      weight *= time_s - p[j].time_s;
    }
    at.weights[i] = weight / denominator;
    at.slopes[i] = slope / denominator;
    at.pixel += at.weights[i] * p[i].pixel;
    at.velocity += at.slopes[i] * p[i].pixel;
  }
  return at;
}

class Problem {
 public:
  Problem(const camera::Camera& first, const camera::Camera& second,
          const std::vector<TrackPair>& tracks, const TimeOffsetOptions& options)
      : first_(first),
        second_(second),
        tracks_(tracks),
        options_(options),
        limit_px_(options.robust_px) {
    const Eigen::Isometry3d T = second.T_camera_rig * first.T_camera_rig.inverse();
    const Eigen::Vector3d t = T.translation().normalized();
    Eigen::Matrix3d cross;
    cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
    E_ = cross * T.linear();
  }

  // Normal equation of one Gauss-Newton step, the mean truncated misfit, and what noise does.
  struct Sum {
    double cost = 0, normal = 0, right = 0, squares = 0;
    // What noise of 1 px makes of `squares` and `normal`, and the variance of `right`.
    double noise_squares = 0, noise_normal = 0, variance = 0;
    int seen = 0, used = 0;
    std::vector<double> misfits;  // px, of all seen
    double mean_cost() const { return cost / seen; }
  };
  Sum Evaluate(double offset_s, bool with_variance = false) const;

  // Misfits beyond 5 standard deviations are no noise; told from the median of all.
  void TightenLimit(double offset_s) {
    std::vector<double> misfits = Evaluate(offset_s, true).misfits;
    const auto middle = misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2);
    std::nth_element(misfits.begin(), middle, misfits.end());
    limit_px_ = std::clamp(5 * 1.4826 * *middle, 1e-6, options_.robust_px);
  }

 private:
  std::optional<Form> Epipolar(const Eigen::Vector2d& first, const Eigen::Vector2d& second) const;

  const camera::Camera& first_;
  const camera::Camera& second_;
  const std::vector<TrackPair>& tracks_;
  const TimeOffsetOptions& options_;
  Eigen::Matrix3d E_;
  double limit_px_;  // misfits beyond do not count
};

// d (undistorted point) / d (pixel).
std::optional<Eigen::Matrix2d> ByPixel(const camera::Camera& camera, const Eigen::Vector3d& x) {
  const camera::Projection projection = camera::Project(camera.lens, x);
  if (!projection.visible) return std::nullopt;
  return projection.jacobian.leftCols<2>().inverse().eval();
}

std::optional<Form> Problem::Epipolar(const Eigen::Vector2d& first,
                                      const Eigen::Vector2d& second) const {
  const auto a = camera::Unproject(first_.lens, first);
  const auto b = camera::Unproject(second_.lens, second);
  if (!a || !b) return std::nullopt;
  const Eigen::Vector3d x1 = a->homogeneous(), x2 = b->homogeneous();
  const auto J1 = ByPixel(first_, x1), J2 = ByPixel(second_, x2);
  if (!J1 || !J2) return std::nullopt;
  const Eigen::Vector3d by_x1 = E_.transpose() * x2, by_x2 = E_ * x1;
  return Form{x2.dot(by_x2), J1->transpose() * by_x1.head<2>(), J2->transpose() * by_x2.head<2>()};
}

Problem::Sum Problem::Evaluate(double offset_s, bool with_variance) const {
  Sum sum;
  for (const TrackPair& track : tracks_) {
    // What each picture of the second camera contributes to the step: neighbours share them.
    std::vector<Eigen::Vector2d> by_second(with_variance ? track.in_second.size() : 0,
                                           Eigen::Vector2d::Zero());
    for (const TimedPixel& seen : track.in_first) {
      const auto at = Interpolate(track.in_second, seen.time_s + offset_s, options_.longest_gap_s);
      const auto form = at ? Epipolar(seen.pixel, at->pixel) : std::nullopt;
      if (!form) continue;
      // The distance to the epipolar lines in px, to first order (Sampson).
      const double scale =
          1 / std::sqrt(form->by_first.squaredNorm() + form->by_second.squaredNorm());
      const double misfit = scale * form->value;
      const double slope = scale * form->by_second.dot(at->velocity);  // px/s
      const double k = limit_px_;
      if (with_variance) sum.misfits.push_back(std::abs(misfit));
      ++sum.seen;
      sum.cost += std::min(misfit * misfit, k * k);
      // A marker found in a wrong place spoils the cubics around it, and their slopes even more.
      if (std::abs(misfit) > k) continue;
      sum.normal += slope * slope;
      sum.right -= slope * misfit;
      sum.squares += misfit * misfit;
      ++sum.used;
      if (!with_variance) continue;
      double shared = 0, shared_slope = 0;
      for (size_t i = 0; i < 4; ++i) {
        by_second[at->from + i] += slope * scale * at->weights[i] * form->by_second;
        shared += at->weights[i] * at->weights[i];
        shared_slope += at->slopes[i] * at->slopes[i];
      }
      const double first2 = form->by_first.squaredNorm(), second2 = form->by_second.squaredNorm();
      sum.variance += std::pow(slope * scale, 2) * first2;
      sum.noise_squares += scale * scale * (first2 + shared * second2);
      sum.noise_normal += scale * scale * shared_slope * second2;
    }
    for (const Eigen::Vector2d& each : by_second) sum.variance += each.squaredNorm();
  }
  return sum;
}

constexpr int kGrid = 40;  // steps of the search to either side

// The offset nearby that fits best, by Gauss-Newton.
double Refine(const Problem& problem, double offset_s, double longest_s) {
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Problem::Sum sum = problem.Evaluate(offset_s);
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
  Problem problem(rig.cameras.at(static_cast<size_t>(first)),
                  rig.cameras.at(static_cast<size_t>(second)), tracks, options);
  TimeOffset result;
  double best = INFINITY;
  for (int i = -kGrid; i <= kGrid; ++i) {
    const double offset = options.longest_s * i / kGrid;
    const Problem::Sum sum = problem.Evaluate(offset);
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
  const Problem::Sum sum = problem.Evaluate(result.offset_s, true);
  result.used = sum.used;
  result.rms_px = std::sqrt(sum.squares / sum.used);
  const double noise = std::sqrt(sum.squares / sum.noise_squares);  // px, of a marker in a picture
  // Markers that stand still seem to move by their noise.
  const double from_noise = noise * noise * sum.noise_normal;
  const double from_motion = sum.normal - from_noise;
  result.sd_s = from_motion > 0 ? noise * std::sqrt(sum.variance) / from_motion : INFINITY;
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
