#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "softforce/vision/tags.h"
#include "vision/board_start.h"

namespace softforce::vision {
namespace {

// Corner c (TL TR BR BL of the tag as it is read) of a tag that stands on the grid turned by
// `turn` quarters, clockwise: its place from the tag's lower left corner, x right, y up.
Eigen::Vector2d CornerPlace(int c, int turn, double side) {
  const int k = (c + turn) % 4;
  return {k == 1 || k == 2 ? side : 0, k == 0 || k == 1 ? side : 0};
}

BoardSightings Sightings(const Board& board, const std::vector<Tag>& tags, int turn) {
  const double pitch = board.tag * (1 + board.gap_ratio);
  BoardSightings seen;
  for (const Tag& tag : tags) {
    const int cell = tag.id - board.first_tag;
    const Eigen::Vector2d lower_left(cell % board.columns * pitch, cell / board.columns * pitch);
    for (int c = 0; c < 4; ++c) {
      seen.places.push_back(lower_left + CornerPlace(c, turn, board.tag));
      seen.pixels.push_back(tag.corners[c]);
    }
  }
  return seen;
}

// Tags of the board, out of those in the picture.
std::vector<Tag> DetectTags(const cv::Mat& grey, const Board& board, int black_border) {
  TagOptions options;
  options.border = 0;  // the corners are measured anew, with a border of their own
  options.black_border = black_border;
  std::vector<Tag> tags = TagDetector(board.family, options).Detect(grey);
  const auto foreign = [&](const Tag& tag) {
    return tag.id < board.first_tag || tag.id >= board.first_tag + board.columns * board.rows;
  };
  tags.erase(std::remove_if(tags.begin(), tags.end(), foreign), tags.end());
  return tags;
}

// The small black squares of Kalibr's layout touch the tags' corners, and libapriltag takes what
// touches for one shape: of the tags on rendered pictures it sees 45 %. Where every pixel takes the
// brightest of its neighbours, the shapes part: 98 %. How much is needed depends on the blur.
std::vector<Tag> DetectTouchingTags(const cv::Mat& grey, const Board& board) {
  const size_t enough = board.columns * board.rows / 2;
  std::vector<Tag> most;
  for (const int black_border : {1, 2}) {  // AprilTag's own; Kalibr's
    for (const int spread : {1, 0, 2}) {   // px
      cv::Mat parted;
      cv::dilate(grey, parted, cv::Mat1b::ones(2 * spread + 1, 2 * spread + 1));
      std::vector<Tag> tags = DetectTags(parted, board, black_border);
      if (tags.size() > most.size()) most = std::move(tags);
      if (most.size() > enough) return most;
    }
  }
  return most;
}

}  // namespace

BoardStart FindAprilGrid(const cv::Mat& grey, const Board& board) {
  constexpr size_t kFewest = 2;  // one alone does not tell which way up the grid's tags stand
  BoardStart start;
  const std::vector<Tag> tags = DetectTouchingTags(grey, board);
  if (tags.size() < kFewest) {
    start.reason =
        fmt::format("{} tag{} of family {} of this board in sight, at least 2 are needed",
                    tags.size(), tags.size() == 1 ? " is" : "s are", board.family);
    return start;
  }
  double side = 0;  // px, mean
  for (const Tag& tag : tags)
    side += (tag.corners[1] - tag.corners[0]).norm() / double(tags.size());
  size_t most = kFewest - 1;
  for (int turn = 0; turn < 4; ++turn) {
    const BoardSightings seen = Sightings(board, tags, turn);
    const std::vector<bool> in_place = InPlace(seen, 4, 0.25 * side);
    const size_t count = std::count(in_place.begin(), in_place.end(), true);
    if (count <= most) continue;
    most = count;
    start.sightings = {};
    for (size_t k = 0; k < seen.places.size(); ++k) {
      if (!in_place[k / 4]) continue;
      start.sightings.places.push_back(seen.places[k]);
      start.sightings.pixels.push_back(seen.pixels[k]);
    }
  }
  if (start.sightings.places.empty()) {
    start.reason = "the tags in sight are not arranged as on this board";
  }
  return start;
}

}  // namespace softforce::vision
