#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "softforce/geometry/rigid.h"
#include "softforce/vision/marker_tracks.h"
#include "vision/track_interpolation.h"

namespace softforce::vision {
namespace {

constexpr double kReach = 5;      // px off the epipolar line, on average; calibration and offset
constexpr int kGrid = 20;         // offsets tried to either side
constexpr size_t kPictures = 60;  // of a track that are compared
constexpr size_t kFewest = 10;
constexpr double kNoPair = kReach * kReach;  // px², of a track without partner

// The same track in undistorted coordinates, without unit.
Track Undistorted(const camera::Camera& camera, const Track& track) {
  Track straight;
  for (const TimedPixel& seen : track) {
    if (const auto x = camera::Unproject(camera.lens, seen.pixel)) {
      straight.push_back({seen.time_s, *x});
    }
  }
  return straight;
}

class Matching {
 public:
  Matching(const camera::Camera& first, const camera::Camera& second,
           const std::vector<Track>& in_first, const std::vector<Track>& in_second,
           const TimeOffsetOptions& options)
      : options_(options), focal_px_((first.lens.fx + second.lens.fx) / 2) {
    const Eigen::Isometry3d T = second.T_camera_rig * first.T_camera_rig.inverse();
    E_ = geometry::Skew(T.translation().normalized()) * T.linear();
    for (const Track& track : in_first) first_.push_back(Undistorted(first, track));
    for (const Track& track : in_second) second_.push_back(Undistorted(second, track));
  }

  // px²: mean squared distance from the epipolar lines of every pair, for one offset.
  Eigen::MatrixXd Costs(double offset_s) const {
    Eigen::MatrixXd costs(first_.size(), second_.size());
    for (Eigen::Index a = 0; a < costs.rows(); ++a) {
      for (Eigen::Index b = 0; b < costs.cols(); ++b) {
        costs(a, b) =
            Cost(first_[static_cast<size_t>(a)], second_[static_cast<size_t>(b)], offset_s);
      }
    }
    return costs;
  }

 private:
  double Cost(const Track& a, const Track& b, double offset_s) const {
    double squares = 0;
    size_t count = 0;
    const size_t step = std::max<size_t>(1, a.size() / kPictures);
    for (size_t i = 0; i < a.size(); i += step) {
      const auto at = Interpolate(b, a[i].time_s + offset_s, options_.longest_gap_s);
      if (!at) continue;
      const Eigen::Vector3d x1 = a[i].pixel.homogeneous(), x2 = at->pixel.homogeneous();
      const Eigen::Vector3d by_x2 = E_ * x1, by_x1 = E_.transpose() * x2;
      const double off = focal_px_ * x2.dot(by_x2) /
                         std::sqrt(by_x1.head<2>().squaredNorm() + by_x2.head<2>().squaredNorm());
      squares += off * off;
      // One that starts so far off is of another marker.
      if (++count == kFewest && squares > 4 * kNoPair * kFewest) return kNoPair;
    }
    return count < kFewest ? kNoPair : std::min(kNoPair, squares / static_cast<double>(count));
  }

  const TimeOffsetOptions& options_;
  double focal_px_;
  Eigen::Matrix3d E_;
  std::vector<Track> first_, second_;
};

}  // namespace

std::vector<TrackPair> PairTracks(const camera::Rig& rig, int first, int second,
                                  const std::vector<Track>& in_first,
                                  const std::vector<Track>& in_second,
                                  const TimeOffsetOptions& options) {
  options.Check();
  if (in_first.empty() || in_second.empty()) return {};
  const Matching matching(rig.cameras.at(static_cast<size_t>(first)),
                          rig.cameras.at(static_cast<size_t>(second)), in_first, in_second,
                          options);
  Eigen::MatrixXd costs;
  double best = std::numeric_limits<double>::infinity();
  for (int i = -kGrid; i <= kGrid; ++i) {
    Eigen::MatrixXd tried = matching.Costs(options.longest_s * i / kGrid);
    const double total = tried.rowwise().minCoeff().sum();
    if (total >= best) continue;
    best = total;
    costs = std::move(tried);
  }
  std::vector<TrackPair> pairs;
  for (Eigen::Index a = 0; a < costs.rows(); ++a) {
    Eigen::Index b = 0, back = 0;
    if (costs.row(a).minCoeff(&b) >= kNoPair) continue;
    costs.col(b).minCoeff(&back);
    if (back != a) continue;
    pairs.push_back({in_first[static_cast<size_t>(a)], in_second[static_cast<size_t>(b)]});
  }
  return pairs;
}

}  // namespace softforce::vision
