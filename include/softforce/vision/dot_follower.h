#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "softforce/vision/dots.h"

namespace softforce::vision {

struct DotFollowerOptions {
  // Around where a dot is expected: this share of its long axis and of its motion, but so many px
  // at least.
  double margin_share = 0.5;
  double min_margin = 10;   // px
  int whole_interval = 15;  // pictures, between searches of the whole picture
  int forget = 60;          // pictures for which a dot that is not seen is looked for in its place
  double most_of_whole =
      0.4;  // share of the picture from which its parts cost as much as the whole

  void Check() const;  // throws InputError naming the option
};

// Finds dots in the pictures of one camera, one after another: first near where they should be,
// from where and how fast they went; one that was lost is expected to go with its neighbours. The
// whole picture is searched at intervals, and after a loss: in the same picture if a dot is lost
// that is clear or was seen 15 times in a row, or most of the faint ones; if in vain, again after
// 4, 8 … pictures, or 1, 2, 4 … if most are gone. Every dot that it finds is the one that
// DetectDots finds in the whole picture, to the last bit. What it finds depends on the pictures and
// their order alone.
class DotFollower {
 public:
  explicit DotFollower(const DotFollowerOptions& options = {});

  // As DetectDots. `dot_options` are meant to stay the same from picture to picture.
  std::vector<Dot> Detect(const cv::Mat& grey, const DotOptions& dot_options = {});

  long whole_searches() const { return whole_searches_; }

 private:
  struct Known {
    Eigen::Vector2d at;        // px; when last seen, or carried on with its neighbours since
    Eigen::Vector2d velocity;  // px per picture
    double long_axis;          // px
    bool clear;                // of so much contrast that noise cannot make it
    int seen;                  // pictures in a row, up to the last in which it was
    int missing;               // pictures since

    double Margin(const DotFollowerOptions& options) const;
    bool IsEstablished() const;  // worth being looked for near its place if it is lost
    bool IsSteady() const;       // worth a search of the whole picture
  };

  std::vector<cv::Rect> Areas(const cv::Mat& grey) const;
  // The known dots after this picture; `lost` is how many steady ones were not seen in it for the
  // first time (and of faint ones, if most are gone), `back` how many of the missing ones were.
  // `whole`: the whole picture was searched, where a dot may have gone further.
  std::vector<Known> Update(const std::vector<Dot>& dots, bool whole, double min_contrast,
                            int* lost, int* back) const;

  DotFollowerOptions options_;
  std::vector<Known> known_;
  int since_whole_ = 0;  // pictures since the whole was searched
  int wait_ = 1;         // pictures that must pass before the whole is searched for the lost
  long whole_searches_ = 0;
};

}  // namespace softforce::vision
