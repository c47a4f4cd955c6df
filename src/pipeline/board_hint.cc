#include "pipeline/board_hint.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/aruco.hpp>
#include <set>

#include "softforce/base/input_error.h"
#include "softforce/vision/board_detector.h"
#include "softforce/vision/board_hint.h"
#include "softforce/vision/tags.h"

namespace softforce::pipeline {
namespace {

using vision::Board;

constexpr int kEnoughMarkers = 4;  // fewer may be chance

// Each contains the smaller ones of its size, with the same ids.
const std::vector<std::pair<const char*, int>> kDictionaries = {
    {"4X4", cv::aruco::DICT_4X4_1000},
    {"5X5", cv::aruco::DICT_5X5_1000},
    {"6X6", cv::aruco::DICT_6X6_1000},
    {"7X7", cv::aruco::DICT_7X7_1000},
    {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL}};

const std::vector<std::string> kFamilies = {"tag36h11", "tag25h9", "tagStandard41h12", "tag16h5"};

std::set<int> MarkerIds(const cv::Mat& picture, int dictionary) {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::aruco::detectMarkers(picture, cv::aruco::getPredefinedDictionary(dictionary), corners, ids);
  return {ids.begin(), ids.end()};
}

std::set<int> TagIds(const cv::Mat& picture, const std::string& family) {
  std::set<int> ids;
  for (const vision::Tag& tag : vision::TagDetector(family).Detect(picture)) ids.insert(tag.id);
  return ids;
}

bool FindsChessboard(const Board& board, int columns, int rows, const cv::Mat& picture) {
  Board other = board;
  other.columns = columns;
  other.rows = rows;
  return vision::DetectBoard(picture, other).ok();
}

// Sizes near the one told, then common ones. Squares taken for inner corners come first; larger
// ones before smaller ones, which may be found within them.
std::vector<std::pair<int, int>> OtherSizes(const Board& board) {
  std::vector<std::pair<int, int>> sizes;
  const auto add = [&](int columns, int rows) {
    const bool told = (columns == board.columns && rows == board.rows) ||
                      (columns == board.rows && rows == board.columns);
    if (columns < 3 || rows < 3 || told) return;
    if (std::count(sizes.begin(), sizes.end(), std::make_pair(columns, rows)) == 0) {
      sizes.emplace_back(columns, rows);
    }
  };
  for (const int step : {1, 2}) {
    for (const int dc : {step, 0, -step}) {
      for (const int dr : {step, 0, -step}) add(board.columns + dc, board.rows + dr);
    }
  }
  for (const auto& [columns, rows] : {std::pair(11, 8),
                                      {10, 7},
                                      {9, 7},
                                      {9, 6},
                                      {8, 6},
                                      {8, 5},
                                      {7, 7},
                                      {7, 6},
                                      {7, 5},
                                      {6, 4}}) {
    add(columns, rows);
  }
  return sizes;
}

std::string OtherChessboard(const Board& board, const cv::Mat& picture) {
  Board chessboard = board;
  chessboard.kind = Board::Kind::kChessboard;
  if (!(chessboard.square > 0)) chessboard.square = 0.02;  // any: only the count matters here
  for (const auto& [columns, rows] : OtherSizes(chessboard)) {
    if (!FindsChessboard(chessboard, columns, rows, picture)) continue;
    return fmt::format(
        "A chessboard of {}x{} inner corners was seen. If that is yours: --board "
        "chessboard:{}x{},square=…",
        columns, rows, columns, rows);
  }
  return "";
}

std::string OtherMarkers(const Board& board, const cv::Mat& picture) {
  for (const auto& [name, dictionary] : kDictionaries) {
    const std::set<int> ids = MarkerIds(picture, dictionary);
    if (static_cast<int>(ids.size()) < kEnoughMarkers) continue;
    return fmt::format(
        "ArUco markers of the dictionaries {} were seen, ids {} to {}. If the board "
        "is a ChArUco: --board charuco:COLUMNSxROWS,square=…,marker=…,dictionary={}_…",
        name, *ids.begin(), *ids.rbegin(), name);
  }
  for (const std::string& family : kFamilies) {
    if (board.kind == Board::Kind::kAprilGrid && family == board.family) continue;
    const std::set<int> ids = TagIds(picture, family);
    if (static_cast<int>(ids.size()) < kEnoughMarkers) continue;
    return fmt::format(
        "AprilTags of the family {} were seen, ids {} to {}. If the board is an "
        "AprilGrid: --board aprilgrid:COLUMNSxROWS,tag=…,spacing=…,family={}",
        family, *ids.begin(), *ids.rbegin(), family);
  }
  return "";
}

}  // namespace

std::string HintAtOtherBoard(const Board& board, const std::vector<cv::Mat>& pictures) {
  for (const cv::Mat& picture : pictures) {
    const std::string mistake = vision::ExplainMissingBoard(picture, board);
    if (!mistake.empty()) return "Instead, " + mistake + ".";
    std::string markers = OtherMarkers(board, picture);
    if (!markers.empty()) return markers;
    std::string chessboard = OtherChessboard(board, picture);
    if (!chessboard.empty()) return chessboard;
  }
  return "Nothing else was recognised either. Check that the whole board is in the picture, sharp, "
         "evenly lit and flat, and that --board says what is printed on it.";
}

void RefuseIdsBeyondBoard(const Board& board, const cv::Mat& picture, const std::string& where) {
  std::set<int> ids;
  int first = 0, count = 0;
  const char* what = "markers";
  if (board.kind == Board::Kind::kCharuco) {
    for (const auto& [name, dictionary] : kDictionaries) {
      if (board.dictionary.rfind(name, 0) == 0) ids = MarkerIds(picture, dictionary);
    }
    const int white = board.columns * board.rows / 2;
    const bool odd = board.columns * board.rows % 2 == 1;
    count = white + (odd && board.legacy && board.rows % 2 == 0 ? 1 : 0);
  } else if (board.kind == Board::Kind::kAprilGrid) {
    ids = TagIds(picture, board.family);
    first = board.first_tag;
    count = board.columns * board.rows;
    what = "tags";
  }
  const auto outside = [&](int id) { return id < first || id >= first + count; };
  if (std::count_if(ids.begin(), ids.end(), outside) < 2) return;  // one may be a misreading
  throw base::InputError(
      where,
      fmt::format("got {} with ids {} to {}, the board of --board has {} to {}", what, *ids.begin(),
                  *ids.rbegin(), first, first + count - 1),
      "The board has more of them than told, or other ones. Count its columns and rows again.");
}

}  // namespace softforce::pipeline
