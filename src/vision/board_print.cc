#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "softforce/vision/tag_cells.h"
#include "vision/board_start.h"

namespace softforce::vision {
namespace {

constexpr double kEven = std::numeric_limits<double>::infinity();  // one field, as far as it goes

CornerPrint Checkered(double square, double marker_margin, bool upper_left_black) {
  CornerPrint print;
  print.sign = upper_left_black ? -1 : 1;
  for (int q = 0; q < 4; ++q) {
    const bool diagonal = q == 0 || q == 3;  // of the upper left field's colour
    const bool black = diagonal == upper_left_black;
    print.quadrants[q] = {square, square, black ? kEven : marker_margin};
  }
  return print;
}

// A tag's corner in Kalibr's layout touches the corner of a small black square.
CornerPrint TagCorner(const Board& board, bool right, bool upper) {
  const TagCells tag = DrawTag(board.family, board.first_tag);
  const int cells = tag.cells.cols - 2 * tag.margin;
  const double gap = board.tag * board.gap_ratio;
  CornerPrint print;
  print.sign = (right == upper) ? -1 : 1;  // black where u v > 0 for lower left and upper right
  for (int q = 0; q < 4; ++q) {
    // The tag lies to the left of its right corners.
    const bool beside_u = ((q & 1) != 0) != right, beside_v = ((q & 2) != 0) != upper;
    print.quadrants[q] = {beside_u ? board.tag : gap, beside_v ? board.tag : gap,
                          beside_u && beside_v ? board.tag / cells : kEven};
  }
  return print;
}

}  // namespace

CornerPrint PrintAround(const Board& board, int id, bool top_left_black) {
  const int i = id / board.point_columns(), j = id % board.point_columns();
  if (board.kind == Board::Kind::kAprilGrid) return TagCorner(board, j % 2 == 1, i % 2 == 1);
  const bool upper_left_black = top_left_black == ((i + j) % 2 == 0);
  const double margin =
      board.kind == Board::Kind::kCharuco ? 0.5 * (board.square - board.marker) : kEven;
  return Checkered(board.square, margin, upper_left_black);
}

std::vector<bool> InPlace(const BoardSightings& sightings, int group, double tolerance) {
  const size_t groups = sightings.places.size() / group;
  std::vector<bool> in_place(groups, true);
  if (groups < 2) return in_place;
  std::vector<cv::Point2d> places, pixels;
  for (size_t k = 0; k < sightings.places.size(); ++k) {
    places.emplace_back(sightings.places[k].x(), sightings.places[k].y());
    pixels.emplace_back(sightings.pixels[k].x(), sightings.pixels[k].y());
  }
  cv::Mat inliers;
  const cv::Mat H = cv::findHomography(places, pixels, cv::RANSAC, tolerance, inliers);
  if (H.empty()) return std::vector<bool>(groups, false);
  for (size_t g = 0; g < groups; ++g) {
    for (int k = 0; k < group; ++k) {
      if (inliers.at<uchar>(static_cast<int>(g) * group + k) == 0) in_place[g] = false;
    }
  }
  return in_place;
}

}  // namespace softforce::vision
