#include "softforce/vision/tag_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

Eigen::Vector2d Middle(const std::array<Eigen::Vector2d, 4>& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

bool Same(const Tag& a, const Tag& b) {
  constexpr double kSamePlace = 3;  // px; tags do not overlap
  return a.id == b.id && (Middle(a.corners) - Middle(b.corners)).norm() < kSamePlace;
}

// Adds what is not there yet: parts that are searched may overlap.
void AddNew(std::vector<Tag> found, std::vector<Tag>* tags) {
  for (Tag& tag : found) {
    const auto is_same = [&](const Tag& other) { return Same(tag, other); };
    if (std::none_of(tags->begin(), tags->end(), is_same)) tags->push_back(std::move(tag));
  }
}

}  // namespace

void TagFollowerOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("tag follower: ") + option, rule);
  };
  require(margin_share >= 0 && std::isfinite(margin_share), "margin_share", "must be 0 or more");
  require(min_margin >= 4 && std::isfinite(min_margin), "min_margin", "must be 4 px or more");
  require(whole_interval >= 1, "whole_interval", "must be 1 picture or more");
  require(forget >= 1, "forget", "must be 1 picture or more");
  require(small_side >= 0, "small_side", "must be 0 px or more");
}

double TagFollower::Known::Side() const {
  double side = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4; ++i) side = std::min(side, (corners[(i + 1) % 4] - corners[i]).norm());
  return side;
}

TagFollower::TagFollower(const TagFollowerOptions& options) : options_(options) {
  options_.Check();
}

std::vector<TagFollower::Area> TagFollower::Areas(const cv::Mat& grey) const {
  const cv::Rect all(0, 0, grey.cols, grey.rows);
  std::vector<Area> areas;
  for (const Known& tag : known_) {
    // One that is not seen may have gone on, or have stopped.
    constexpr int kMostSteps = 3;
    const double steps = std::min(tag.missing + 1, kMostSteps);
    const double margin = std::max(options_.min_margin, options_.margin_share * tag.Side()) +
                          (steps - 1) * tag.velocity.norm();
    Eigen::Vector2d low = tag.corners[0], high = low;
    for (const Eigen::Vector2d& corner : tag.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    low += (tag.velocity.array() - margin).matrix();
    high += (tag.velocity.array() + margin).matrix();
    const cv::Rect rect =
        cv::Rect(cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
                 cv::Point(static_cast<int>(high.x()) + 1, static_cast<int>(high.y()) + 1)) &
        all;
    if (rect.empty()) continue;
    areas.push_back({rect, tag.Side() < options_.small_side ? 1.0 : 2.0});
  }
  // Parts that overlap much are searched together.
  for (size_t i = 0; i < areas.size(); ++i) {
    for (size_t j = i + 1; j < areas.size();) {
      const cv::Rect both = areas[i].rect | areas[j].rect;
      if (both.area() > areas[i].rect.area() + areas[j].rect.area()) {
        ++j;
        continue;
      }
      areas[i] = {both, std::min(areas[i].decimate, areas[j].decimate)};
      areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  }
  return areas;
}

bool TagFollower::WholeIsDue() const {
  if (known_.empty() || since_whole_ >= options_.whole_interval) return true;
  const bool lost =
      std::any_of(known_.begin(), known_.end(), [](const Known& tag) { return tag.missing > 0; });
  return lost && since_whole_ >= wait_;
}

std::vector<Tag> TagFollower::SearchWhole(const TagDetector& detector, const cv::Mat& grey,
                                          const camera::Lens* lens) {
  constexpr int kFullEvery = 5;  // pictures, while nothing is known
  ++whole_searches_;
  since_whole_ = 0;
  const bool small = std::any_of(known_.begin(), known_.end(), [&](const Known& tag) {
    return tag.Side() < options_.small_side;
  });
  const bool full = small || (known_.empty() && (pictures_ - 1) % kFullEvery == 0);
  const cv::Rect all(0, 0, grey.cols, grey.rows);
  return full ? detector.DetectIn(grey, all, 1, lens) : detector.Detect(grey, lens);
}

int TagFollower::Update(const std::vector<Tag>& tags) {
  std::vector<Known> now;
  int back = 0;
  std::vector<char> taken(known_.size(), 0);
  for (const Tag& tag : tags) {
    Known next{tag.id, tag.corners, Eigen::Vector2d::Zero(), 0};
    size_t best = known_.size();
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < known_.size(); ++k) {
      const double distance = (Middle(known_[k].corners) - Middle(tag.corners)).norm();
      if (taken[k] || known_[k].id != tag.id || distance >= nearest) continue;
      best = k;
      nearest = distance;
    }
    if (best < known_.size()) {
      taken[best] = 1;
      const Known& before = known_[best];
      back += before.missing > 0;
      next.velocity = (Middle(tag.corners) - Middle(before.corners)) / (before.missing + 1);
    }
    now.push_back(next);
  }
  for (size_t k = 0; k < known_.size(); ++k) {
    if (taken[k] || known_[k].missing >= options_.forget) continue;
    now.push_back(known_[k]);
    ++now.back().missing;
  }
  known_ = std::move(now);
  return back;
}

std::vector<Tag> TagFollower::Detect(const TagDetector& detector, const cv::Mat& grey,
                                     const camera::Lens* lens) {
  if (grey.empty()) return {};
  ++pictures_;
  ++since_whole_;
  std::vector<Tag> tags;
  for (const Area& area : Areas(grey)) {
    AddNew(detector.DetectIn(grey, area.rect, area.decimate, lens), &tags);
  }
  // Counted before the whole is searched, so that a loss is answered in the same picture.
  std::vector<Known> before = known_;
  int back = Update(tags);
  const bool whole = WholeIsDue();
  if (whole) {
    const std::vector<Tag> found = SearchWhole(detector, grey, lens);
    known_ = std::move(before);
    AddNew(found, &tags);
    back = Update(tags);
  }
  const bool lost =
      std::any_of(known_.begin(), known_.end(), [](const Known& tag) { return tag.missing > 0; });
  if (back > 0 || !lost) {
    wait_ = 1;
  } else if (whole) {
    wait_ = std::min(2 * wait_, options_.whole_interval);
  }
  std::sort(tags.begin(), tags.end(), [](const Tag& a, const Tag& b) {
    return std::make_pair(a.id, a.corners[0].y()) < std::make_pair(b.id, b.corners[0].y());
  });
  return tags;
}

}  // namespace softforce::vision
