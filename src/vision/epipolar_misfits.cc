#include "vision/epipolar_misfits.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace softforce::vision {
namespace {

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// px², summed over the pictures of a track: less of a way is mostly noise, which is in the misfits
// too and must not be taken off them. A share of 1 % of it would be as much as a noise of 0.1 px.
constexpr double kLeastWay = 100;

// d (undistorted point) / d (pixel).
std::optional<Eigen::Matrix2d> ByPixel(const camera::Camera& camera, const Eigen::Vector3d& x) {
  const camera::Projection projection = camera::Project(camera.lens, x);
  if (!projection.visible) return std::nullopt;
  return projection.jacobian.leftCols<2>().inverse().eval();
}

}  // namespace

// A rig is calibrated to some tenths of a pixel, and a disc's picture is not centred on its centre:
// so a track may be off its lines by a constant, and by a share of how far it is along. Both are
// taken off the misfits, and off the slopes, which leaves what only an offset explains. Gives how
// many numbers that took.
int EpipolarMisfits::TakeOffWhatTheRigMayBeWrongBy(std::vector<Misfit>* track) {
  const auto n = static_cast<Eigen::Index>(track->size());
  if (n < 4) return static_cast<int>(n);
  Eigen::MatrixX2d known(n, 2), values(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Misfit& misfit = (*track)[static_cast<size_t>(i)];
    known.row(i) << 1, misfit.along;
    values.row(i) << misfit.px, misfit.slope;
  }
  known.col(1).array() -= known.col(1).mean();
  values.rowwise() -= values.colwise().mean();
  const double spread = known.col(1).squaredNorm() + kLeastWay;
  values -= known.col(1) * (known.col(1).transpose() * values) / spread;
  for (Eigen::Index i = 0; i < n; ++i) {
    (*track)[static_cast<size_t>(i)].px = values(i, 0);
    (*track)[static_cast<size_t>(i)].slope = values(i, 1);
  }
  return 2;
}

EpipolarMisfits::EpipolarMisfits(const camera::Camera& first, const camera::Camera& second,
                                 const std::vector<TrackPair>& tracks,
                                 const TimeOffsetOptions& options)
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

void EpipolarMisfits::TightenLimit(double offset_s) {
  const double median = Median(Evaluate(offset_s).misfits);
  limit_px_ = std::clamp(5 * 1.4826 * median, 1e-6, options_.robust_px);
}

std::optional<EpipolarMisfits::Form> EpipolarMisfits::Epipolar(
    const Eigen::Vector2d& first, const Eigen::Vector2d& second) const {
  const auto a = camera::Unproject(first_.lens, first);
  const auto b = camera::Unproject(second_.lens, second);
  if (!a || !b) return std::nullopt;
  const Eigen::Vector3d x1 = a->homogeneous(), x2 = b->homogeneous();
  const auto J1 = ByPixel(first_, x1), J2 = ByPixel(second_, x2);
  if (!J1 || !J2) return std::nullopt;
  const Eigen::Vector3d by_x1 = E_.transpose() * x2, by_x2 = E_ * x1;
  return Form{x2.dot(by_x2), J1->transpose() * by_x1.head<2>(), J2->transpose() * by_x2.head<2>()};
}

std::vector<EpipolarMisfits::Misfit> EpipolarMisfits::MisfitsOf(const TrackPair& track,
                                                                double offset_s) const {
  std::vector<Misfit> misfits;
  for (const TimedPixel& seen : track.in_first) {
    const auto at = Interpolate(track.in_second, seen.time_s + offset_s, options_.longest_gap_s);
    const auto form = at ? Epipolar(seen.pixel, at->pixel) : std::nullopt;
    if (!form) continue;
    // The distance to the epipolar lines in px, to first order (Sampson).
    const double scale =
        1 / std::sqrt(form->by_first.squaredNorm() + form->by_second.squaredNorm());
    misfits.push_back({scale * form->value, scale * form->by_second.dot(at->velocity),
                       scale * form->by_second.dot(at->pixel), *form, scale, *at});
  }
  return misfits;
}

void EpipolarMisfits::Add(const TrackPair& track, const std::vector<Misfit>& misfits,
                          Sum* sum) const {
  std::vector<double> px;
  for (const Misfit& misfit : misfits) px.push_back(misfit.px);
  const double middle = Median(px);
  // A marker found in a wrong place spoils the cubics around it, and their slopes even more.
  std::vector<Misfit> good;
  for (const Misfit& misfit : misfits) {
    const double off = std::abs(misfit.px - middle);
    sum->misfits.push_back(off);
    ++sum->seen;
    sum->cost += std::min(off * off, limit_px_ * limit_px_);
    if (off <= limit_px_) good.push_back(misfit);
  }
  const int lost = TakeOffWhatTheRigMayBeWrongBy(&good);
  const auto count = static_cast<double>(good.size());
  if (count <= lost) return;
  const double freedom = 1 - lost / count;
  // What each picture of the second camera contributes to the step: neighbours share them.
  std::vector<Eigen::Vector2d> by_second(track.in_second.size(), Eigen::Vector2d::Zero());
  double right = 0;
  for (const Misfit& each : good) {
    sum->normal += each.slope * each.slope;
    right -= each.slope * each.px;
    sum->squares += each.px * each.px;
    ++sum->used;
    double shared = 0, shared_slope = 0;
    for (size_t i = 0; i < 4; ++i) {
      by_second[each.at.from + i] +=
          each.slope * each.scale * each.at.weights[i] * each.form.by_second;
      shared += each.at.weights[i] * each.at.weights[i];
      shared_slope += each.at.slopes[i] * each.at.slopes[i];
    }
    const double first2 = each.form.by_first.squaredNorm();
    const double second2 = each.form.by_second.squaredNorm();
    const double scale2 = each.scale * each.scale;
    sum->variance += each.slope * each.slope * scale2 * first2;
    sum->noise_squares += freedom * scale2 * (first2 + shared * second2);
    sum->noise_normal += freedom * scale2 * shared_slope * second2;
  }
  for (const Eigen::Vector2d& each : by_second) sum->variance += each.squaredNorm();
  sum->right += right;
  sum->right_squares += right * right;
  ++sum->tracks;
}

EpipolarMisfits::Sum EpipolarMisfits::Evaluate(double offset_s) const {
  Sum sum;
  for (const TrackPair& track : tracks_) {
    const std::vector<Misfit> misfits = MisfitsOf(track, offset_s);
    if (!misfits.empty()) Add(track, misfits, &sum);
  }
  return sum;
}

}  // namespace softforce::vision
