#include "softforce/vision/dot_follower.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

constexpr int kEstablished = 3;  // pictures in a row; what was seen less often may be noise
constexpr int kSteady = 15;      // pictures in a row; a faint thing seen less often may flicker
constexpr int kPatience = 4;     // pictures without a search of the whole after one in vain

// Parts that overlap much are searched together.
void Merge(std::vector<cv::Rect>* areas) {
  for (size_t i = 0; i < areas->size(); ++i) {
    for (size_t j = i + 1; j < areas->size();) {
      cv::Rect& a = (*areas)[i];
      const cv::Rect both = a | (*areas)[j];
      if (both.area() > a.area() + (*areas)[j].area()) {
        ++j;
        continue;
      }
      a = both;
      areas->erase(areas->begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  }
}

}  // namespace

void DotFollowerOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("dot follower: ") + option, rule);
  };
  require(margin_share >= 0 && std::isfinite(margin_share), "margin_share", "must be 0 or more");
  require(min_margin >= 4 && std::isfinite(min_margin), "min_margin", "must be 4 px or more");
  require(whole_interval >= 1, "whole_interval", "must be 1 picture or more");
  require(forget >= 1, "forget", "must be 1 picture or more");
  require(most_of_whole >= 0 && most_of_whole <= 1, "most_of_whole", "must lie in [0, 1]");
}

DotFollower::DotFollower(const DotFollowerOptions& options) : options_(options) {
  options_.Check();
}

double DotFollower::Known::Margin(const DotFollowerOptions& options) const {
  return std::max(options.min_margin, options.margin_share * (long_axis + velocity.norm()));
}

bool DotFollower::Known::IsEstablished() const { return clear || seen >= kEstablished; }

bool DotFollower::Known::IsSteady() const { return clear || seen >= kSteady; }

std::vector<cv::Rect> DotFollower::Areas(const cv::Mat& grey) const {
  const cv::Rect all(0, 0, grey.cols, grey.rows);
  std::vector<cv::Rect> areas;
  for (const Known& dot : known_) {
    const Eigen::Vector2d expected = dot.at + dot.velocity;
    const double reach = 0.5 * dot.long_axis + dot.Margin(options_);
    const int side = static_cast<int>(std::ceil(2 * reach)) + 1;
    const cv::Rect rect(static_cast<int>(std::floor(expected.x() - reach)),
                        static_cast<int>(std::floor(expected.y() - reach)), side, side);
    if (!(rect & all).empty()) areas.push_back(rect & all);
  }
  Merge(&areas);
  return areas;
}

std::vector<DotFollower::Known> DotFollower::Update(const std::vector<Dot>& dots, bool whole,
                                                    double min_contrast, int* lost,
                                                    int* back) const {
  constexpr double kClear = 2;          // smallest contrasts
  constexpr double kToNeighbour = 0.4;  // of the way to the next dot, a dot may have jumped
  std::vector<std::tuple<double, size_t, size_t>> pairs;  // distance px, known, dot
  for (size_t k = 0; k < known_.size(); ++k) {
    const Eigen::Vector2d expected = known_[k].at + known_[k].velocity;
    double gate = 0.5 * known_[k].long_axis + known_[k].Margin(options_);
    if (whole) {
      double neighbour = INFINITY;
      for (size_t i = 0; i < known_.size(); ++i) {
        if (i != k) neighbour = std::min(neighbour, (known_[i].at - known_[k].at).norm());
      }
      gate = std::max(gate, kToNeighbour * neighbour);
    }
    for (size_t d = 0; d < dots.size(); ++d) {
      const double distance = (dots[d].centroid - expected).norm();
      if (distance < gate) pairs.emplace_back(distance, k, d);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> known_of(dots.size(), -1), dot_of(known_.size(), -1);
  for (const auto& [distance, k, d] : pairs) {
    if (known_of[d] >= 0 || dot_of[k] >= 0) continue;
    known_of[d] = static_cast<int>(k);
    dot_of[k] = static_cast<int>(d);
  }
  std::vector<Known> now;
  *lost = *back = 0;
  for (size_t d = 0; d < dots.size(); ++d) {
    Known next{dots[d].centroid,
               Eigen::Vector2d::Zero(),
               dots[d].long_axis,
               std::abs(dots[d].contrast) >= kClear * min_contrast,
               1,
               0};
    if (known_of[d] >= 0) {
      const Known& before = known_[known_of[d]];
      *back += before.missing > 0;
      // One that was missing was carried on with its neighbours, and goes as they do.
      next.velocity = before.missing > 0 ? before.velocity : next.at - before.at;
      next.seen = before.missing > 0 ? 1 : before.seen + 1;
    }
    now.push_back(next);
  }
  const size_t num_seen = now.size();
  int faint = 0, faint_lost = 0;
  for (size_t k = 0; k < known_.size(); ++k) {
    Known gone = known_[k];
    const bool is_faint = gone.IsEstablished() && !gone.IsSteady() && gone.missing == 0;
    faint += is_faint;
    if (dot_of[k] >= 0 || gone.missing >= options_.forget) continue;
    if (!gone.IsEstablished()) continue;
    faint_lost += is_faint;
    *lost += gone.missing == 0 && gone.IsSteady();
    ++gone.missing;
    // With the neighbour next to it that was followed up to here.
    double nearest = INFINITY;
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
    for (size_t i = 0; i < num_seen; ++i) {
      if (now[i].seen < 2) continue;
      const double distance = (now[i].at - gone.at).norm();
      if (distance < nearest) std::tie(nearest, velocity) = std::tie(distance, now[i].velocity);
    }
    gone.at += velocity;
    gone.velocity = velocity;
    now.push_back(gone);
  }
  // One that flickers is no news; when most are gone, they have moved.
  if (2 * faint_lost > faint) *lost += faint_lost;
  return now;
}

std::vector<Dot> DotFollower::Detect(const cv::Mat& grey, const DotOptions& dot_options) {
  if (grey.empty()) return {};
  ++since_whole_;
  const std::vector<cv::Rect> areas = Areas(grey);
  double share = 0;
  for (const cv::Rect& area : areas) {
    share += static_cast<double>(area.area()) / static_cast<double>(grey.total());
  }
  const auto is_missing = [](const Known& dot) { return dot.missing > 0 && dot.IsSteady(); };
  const bool missing = std::any_of(known_.begin(), known_.end(), is_missing);
  bool whole = known_.empty() || since_whole_ >= options_.whole_interval ||
               share > options_.most_of_whole || (missing && since_whole_ >= wait_);
  std::vector<Dot> dots;
  std::vector<Known> next;
  int lost = 0, back = 0;
  if (!whole) {
    dots = DetectDotsIn(grey, areas, dot_options);
    next = Update(dots, false, dot_options.min_contrast, &lost, &back);
    whole = lost > 0;
  }
  if (whole) {
    ++whole_searches_;
    since_whole_ = 0;
    dots = DetectDots(grey, dot_options);
    next = Update(dots, true, dot_options.min_contrast, &lost, &back);
  }
  // One that is covered comes back near its place; when most are gone, anything may have happened.
  const bool most = 2 * static_cast<size_t>(lost) > known_.size();
  known_ = std::move(next);
  const bool still = std::any_of(known_.begin(), known_.end(), is_missing);
  if (back > 0 || lost > 0 || !still) {
    wait_ = most ? 1 : kPatience;
  } else if (whole) {
    wait_ = std::min(2 * wait_, options_.whole_interval);
  }
  return dots;
}

}  // namespace softforce::vision
