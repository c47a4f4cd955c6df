#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/camera/lens.h"

namespace softforce::vision {

// An AprilTag seen in one picture.
struct Tag {
  std::string family;
  int id = -1;
  // px, the OpenCV convention (pixel (0, 0) is the CENTRE of the top-left pixel): top left, top
  // right, bottom right, bottom left of the black square of the upright tag. Upright is how
  // OpenCV's aruco module draws a tag; AprilTag's own pictures of 36h11, 25h9 and 16h5 stand upside
  // down against it.
  std::array<Eigen::Vector2d, 4> corners;
  std::array<Eigen::Matrix2d, 4> corner_covariances;  // px²
  double decision_margin = NAN;  // AprilTag's own measure of how sure the code is
};

struct TagOptions {
  double decimate = 2;         // AprilTag looks for squares in a picture this many times smaller
  int max_corrected_bits = 1;  // Hamming distance still accepted
  double min_decision_margin = 20;
  int black_border = 1;  // cells of black around the code; AprilTag's own have 1, Kalibr's grids 2
  double border = 3;     // px; tags closer to the picture's edge are refused, being clipped

  void Check() const;  // throws InputError naming the option
};

// Finds the tags of one family. AprilTag 3 reports corners in a frame where the pixel CORNER is (0,
// 0); that half pixel is taken off here, once. Corners are then refined: a blurred step is fitted
// to each side at the full resolution, and neighbouring sides are intersected.
class TagDetector {
 public:
  // `family`: tag36h11, tag25h9, tag16h5 or tagStandard41h12; throws InputError for any other.
  explicit TagDetector(const std::string& family, const TagOptions& options = {});
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;

  // Tags in an 8-bit grey picture, ordered by id, then row. With the lens that took the picture,
  // sides are fitted with the lines that the lens makes of straight ones; without, the corners of a
  // tag of 100 px may be off by some 0.05 px.
  std::vector<Tag> Detect(const cv::Mat& grey, const camera::Lens* lens = nullptr) const;

  // The same for tags that lie wholly in a part of the picture, looked for in one that is
  // `decimate` times smaller. Nothing is copied; corners are those in the whole picture.
  std::vector<Tag> DetectIn(const cv::Mat& grey, const cv::Rect& area, double decimate,
                            const camera::Lens* lens = nullptr) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
