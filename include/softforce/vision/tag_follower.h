#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "softforce/vision/tags.h"

namespace softforce::vision {

struct TagFollowerOptions {
  // Around where a tag is expected: this share of its size, but so many px at least.
  double margin_share = 0.5;
  double min_margin = 12;   // px
  int whole_interval = 15;  // pictures, between searches of the whole picture
  int forget = 60;          // pictures for which a tag that is not seen is looked for in its place
  double small_side = 30;   // px; smaller tags are looked for at the full resolution

  void Check() const;  // throws InputError naming the option
};

// Finds tags in the pictures of one camera, one after another: first near where they should be,
// from where and how fast they went. The whole picture is searched at intervals, and after a loss:
// at once, then after 2, 4, 8 … pictures, so that a tag that stays away costs little. What it finds
// depends on the pictures and their order alone.
class TagFollower {
 public:
  explicit TagFollower(const TagFollowerOptions& options = {});

  // As TagDetector::Detect.
  std::vector<Tag> Detect(const TagDetector& detector, const cv::Mat& grey,
                          const camera::Lens* lens = nullptr);

  long whole_searches() const { return whole_searches_; }

 private:
  struct Known {
    int id;
    std::array<Eigen::Vector2d, 4> corners;  // px, when last seen
    Eigen::Vector2d velocity;                // px per picture
    int missing;                             // pictures since

    double Side() const;  // px, of the shortest
  };
  struct Area {
    cv::Rect rect;
    double decimate;
  };

  std::vector<Area> Areas(const cv::Mat& grey) const;
  bool WholeIsDue() const;
  std::vector<Tag> SearchWhole(const TagDetector& detector, const cv::Mat& grey,
                               const camera::Lens* lens);
  // Returns how many of the tags that were missed have come back.
  int Update(const std::vector<Tag>& tags);

  TagFollowerOptions options_;
  std::vector<Known> known_;
  int pictures_ = 0;
  int since_whole_ = 0;  // pictures since the whole was searched
  int wait_ = 1;         // pictures that must pass before the whole is searched for the lost
  long whole_searches_ = 0;
};

}  // namespace softforce::vision
