#include <algorithm>
#include <limits>

#include "softforce/vision/marker_tracks.h"

namespace softforce::vision {
namespace {

constexpr double kShareOfSpacing = 0.4;
constexpr double kFurthest = 60;  // px, for a spot that stands alone

Eigen::Vector2d Expected(const Track& track, double time_s) {
  const TimedPixel& last = track.back();
  if (track.size() < 2) return last.pixel;
  const TimedPixel& before = track[track.size() - 2];
  const double share = (time_s - last.time_s) / (last.time_s - before.time_s);
  return last.pixel + share * (last.pixel - before.pixel);
}

struct Nearest {
  size_t index = 0;
  double distance = std::numeric_limits<double>::infinity();
};

Nearest NearestTo(const Eigen::Vector2d& place, const std::vector<Eigen::Vector2d>& others,
                  size_t except = std::numeric_limits<size_t>::max()) {
  Nearest nearest;
  for (size_t i = 0; i < others.size(); ++i) {
    const double distance = (others[i] - place).norm();
    if (i != except && distance < nearest.distance) nearest = {i, distance};
  }
  return nearest;
}

}  // namespace

void SpotFollower::Add(double time_s, const std::vector<Eigen::Vector2d>& spots) {
  const auto is_over = [&](const Track& t) { return t.back().time_s < time_s - longest_gap_s_; };
  const auto over = std::stable_partition(live_.begin(), live_.end(),
                                          [&](const Track& track) { return !is_over(track); });
  std::move(over, live_.end(), std::back_inserter(ended_));
  live_.erase(over, live_.end());

  std::vector<Eigen::Vector2d> expected;
  for (const Track& track : live_) expected.push_back(Expected(track, time_s));
  for (size_t i = 0; i < spots.size(); ++i) {
    const double reach =
        std::min(kFurthest, kShareOfSpacing * NearestTo(spots[i], spots, i).distance);
    const Nearest track = NearestTo(spots[i], expected);
    const bool mutual =
        track.distance < reach && NearestTo(expected[track.index], spots).index == i;
    if (mutual) {
      live_[track.index].push_back(TimedPixel{time_s, spots[i]});
    } else {
      live_.push_back(Track{TimedPixel{time_s, spots[i]}});
    }
  }
}

std::vector<Track> SpotFollower::Tracks(size_t fewest) const {
  std::vector<Track> tracks;
  for (const auto* list : {&ended_, &live_}) {
    std::copy_if(list->begin(), list->end(), std::back_inserter(tracks),
                 [&](const Track& track) { return track.size() >= fewest; });
  }
  return tracks;
}

}  // namespace softforce::vision
