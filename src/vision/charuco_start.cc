#include <fmt/format.h>

#include <opencv2/aruco.hpp>

#include "vision/board_start.h"
#include "vision/marker_dictionary.h"

namespace softforce::vision {
namespace {

// Upper left corners of the white squares in the order of the markers' ids: row by row.
std::vector<Eigen::Vector2d> MarkerPlaces(const Board& board) {
  std::vector<Eigen::Vector2d> places;
  const int first_black = board.legacy && board.rows % 2 == 0 ? 1 : 0;
  const double margin = 0.5 * (board.square - board.marker);
  for (int i = 0; i < board.rows; ++i) {
    for (int j = 0; j < board.columns; ++j) {
      if ((i + j) % 2 == first_black) continue;
      places.emplace_back(j * board.square + margin, i * board.square + margin);
    }
  }
  return places;
}

struct Markers {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;  // from the top left, clockwise
};

// The markers' corners where `board` has them; those out of place with the others left out.
BoardSightings InPlaceOn(const Board& board, const Markers& markers) {
  const std::vector<Eigen::Vector2d> places = MarkerPlaces(board);
  BoardSightings seen;
  double side = 0;  // px, sum
  for (size_t k = 0; k < markers.ids.size(); ++k) {
    if (markers.ids[k] >= static_cast<int>(places.size())) continue;
    for (int c = 0; c < 4; ++c) {
      const Eigen::Vector2d offset(c == 1 || c == 2 ? board.marker : 0, c >= 2 ? board.marker : 0);
      seen.places.push_back(places[markers.ids[k]] + offset);
      seen.pixels.emplace_back(markers.corners[k][c].x, markers.corners[k][c].y);
    }
    side += cv::norm(markers.corners[k][1] - markers.corners[k][0]);
  }
  if (seen.places.empty()) return seen;
  side *= 4 / static_cast<double>(seen.places.size());
  const std::vector<bool> in_place = InPlace(seen, 4, 0.25 * side);
  BoardSightings kept;
  for (size_t k = 0; k < seen.places.size(); ++k) {
    if (!in_place[k / 4]) continue;
    kept.places.push_back(seen.places[k]);
    kept.pixels.push_back(seen.pixels[k]);
  }
  return kept;
}

}  // namespace

BoardStart FindCharuco(const cv::Mat& grey, const Board& board) {
  BoardStart start;
  start.top_left_black = !(board.legacy && board.rows % 2 == 0);
  const auto dictionary = MarkerDictionary(board.dictionary, "charuco: dictionary");
  Markers markers;
  cv::aruco::detectMarkers(grey, dictionary, markers.corners, markers.ids);
  start.sightings = InPlaceOn(board, markers);
  if (start.sightings.places.empty()) {
    start.reason = fmt::format("no marker of dictionary {} is in sight where this board has it",
                               board.dictionary);
    return start;
  }
  // The two patterns agree on most markers, but for a shift by a square.
  Board other = board;
  other.legacy = !board.legacy;
  if (board.rows % 2 == 0 &&
      InPlaceOn(other, markers).places.size() > start.sightings.places.size()) {
    start.sightings = {};
    start.reason = fmt::format("the markers are arranged as on a board {} \"legacy\": {}",
                               other.legacy ? "with" : "without", other.Text());
  }
  return start;
}

}  // namespace softforce::vision
