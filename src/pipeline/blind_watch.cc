#include "pipeline/blind_watch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace softforce::pipeline {
namespace {

constexpr int kFrames = 10;        // in a row that the markers must be off
constexpr int kFramesFailed = 3;   // without forces, in the last of which they are
constexpr double kSds = 6;         // standard deviations that they must be off
constexpr double kFloor = 0.1e-3;  // m
constexpr double kSamePlace = 2;   // px
constexpr double kSameShare = 2.0 / 3;
constexpr int kFirstPause = 30, kLongestPause = 240;  // frames that are not tried in between

}  // namespace

BlindWatch::Places BlindWatch::PlacesOf(const std::vector<CameraDetections>& detections) {
  Places places;
  for (const CameraDetections& camera : detections) {
    places.emplace_back();
    for (const vision::Dot& dot : camera.dots) places.back().push_back(dot.centroid);
    for (const vision::Tag& tag : camera.tags) places.back().push_back(tag.corners[0]);
  }
  return places;
}

std::optional<BlindWatch::Misfit> BlindWatch::Compare(const Estimated& estimated) {
  const auto& [frame, usable, detections, observations, X, u, common_model_error, standing] =
      estimated;
  std::vector<Eigen::Vector3d> model, measured;
  double displacement = 0;  // m, the largest
  for (const MarkerObservation& observation : observations) {
    const estimation::Observation& seen = observation.seen;
    if (seen.whitening.rows() < 3 || !seen.position.allFinite()) continue;
    model.emplace_back(seen.at.Apply(X + u) + seen.offset);
    measured.push_back(seen.position);
    displacement = std::max(displacement, seen.at.Apply(u).norm());
  }
  if (model.size() < 4) return std::nullopt;  // too few to tell; neither for nor against
  const auto n = static_cast<Eigen::Index>(model.size());
  const auto points = [n](const std::vector<Eigen::Vector3d>& list) {
    return Eigen::Map<const Eigen::Matrix3Xd>(list.front().data(), 3, n);
  };
  const Eigen::Isometry3d offset(Eigen::umeyama(points(model), points(measured), false));
  const Eigen::Vector3d centre = points(model).rowwise().mean();
  double before = 0, after = 0;  // m², mean squares
  for (size_t i = 0; i < model.size(); ++i) {
    before += (measured[i] - model[i]).squaredNorm() / static_cast<double>(n);
    after += (measured[i] - offset * model[i]).squaredNorm() / static_cast<double>(n);
  }
  const double sd =
      std::sqrt(kFloor * kFloor + std::pow(common_model_error * displacement, 2) +
                PointCovariance(standing.T_rig_robot, standing.covariance, centre).trace() / 3);
  // Off alike: a rigid motion takes most of the misfit away.
  return Misfit{std::sqrt(before) > kSds * sd && after < before / 4,
                (offset * centre - centre).norm(), Eigen::AngleAxisd(offset.linear()).angle()};
}

std::optional<BlindWatch::Finding> BlindWatch::Look(const Estimated& estimated) {
  if (!estimated.usable && failed_ == 0) failed_since_ = estimated.frame;
  failed_ = estimated.usable ? 0 : failed_ + 1;
  const std::optional<Misfit> misfit = Compare(estimated);
  if (!misfit) return std::nullopt;
  if (!misfit->off) {
    off_ = 0;
    if (estimated.usable) last_good_ = PlacesOf(estimated.detections);
    if (!estimated.usable || !std::exchange(lost_, false)) return std::nullopt;
    return Finding{Finding::Kind::kBack, estimated.frame, 0, 0};
  }
  if (off_++ == 0) off_since_ = estimated.frame;
  const bool failing = failed_ >= kFramesFailed && off_ < kFrames;
  if (lost_ || (off_ != kFrames && !failing)) return std::nullopt;
  lost_ = failed_ >= kFramesFailed;
  untried_ = 0;
  next_try_ = kFirstPause;
  if (failing) off_ = kFrames;  // told once
  // So far off that markers were not found at once counts as well.
  const int since = lost_ ? std::min(failed_since_, off_since_) : off_since_;
  return Finding{Finding::Kind::kOffAlike, since, misfit->moved, misfit->turned};
}

bool BlindWatch::WorthATry(const std::vector<CameraDetections>& detections) {
  if (!lost_) return true;
  const Places places = PlacesOf(detections);
  size_t all = 0, same = 0;
  for (size_t c = 0; c < std::min(places.size(), last_good_.size()); ++c) {
    for (const Eigen::Vector2d& before : last_good_[c]) {
      ++all;
      same += std::any_of(places[c].begin(), places[c].end(), [&](const Eigen::Vector2d& now) {
        return (now - before).norm() < kSamePlace;
      });
    }
  }
  if (all > 0 && static_cast<double>(same) >= kSameShare * static_cast<double>(all)) return true;
  if (++untried_ < next_try_) return false;
  untried_ = 0;
  next_try_ = std::min(2 * next_try_, kLongestPause);
  return true;
}

void BlindWatch::Forget() {
  off_ = failed_ = 0;
  lost_ = false;
}

}  // namespace softforce::pipeline
