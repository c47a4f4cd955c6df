#include "softforce/vision/board_hint.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

struct Mistake {
  Board meant;
  std::string explanation;
};

void AddSizes(const Board& board, const char* fewer, const char* more,
              std::vector<Mistake>* mistakes) {
  Board other = board;
  --other.columns, --other.rows;
  mistakes->push_back({other, fewer});
  other = board;
  ++other.columns, ++other.rows;
  mistakes->push_back({other, more});
  if (board.columns == board.rows) return;
  other = board;
  std::swap(other.columns, other.rows);
  mistakes->push_back({other, "columns and rows are swapped"});
}

std::vector<Mistake> Mistakes(const Board& board) {
  std::vector<Mistake> mistakes;
  switch (board.kind) {
    case Board::Kind::kChessboard:
      AddSizes(board, "a chessboard counts inner corners, not squares",
               "one more inner corner each way is there", &mistakes);
      break;
    case Board::Kind::kCharuco: {
      Board other = board;
      other.legacy = !board.legacy;
      mistakes.push_back({other, "the pattern of OpenCV changed with version 4.6"});
      for (const char* cells : {"4X4", "5X5", "6X6", "7X7"}) {
        other = board;
        other.dictionary = std::string(cells) + "_1000";
        if (board.dictionary.substr(0, 3) == cells) continue;
        mistakes.push_back({other, "its markers are of another dictionary"});
      }
      break;
    }
    case Board::Kind::kAprilGrid:
      for (const char* family : {"tag36h11", "tag25h9", "tag16h5"}) {
        Board other = board;
        other.family = family;
        if (board.family != family) {
          mistakes.push_back({other, "its tags are of another family"});
        }
      }
      break;
    case Board::Kind::kCircles:
      AddSizes(board, "one circle fewer each way is there", "one circle more each way is there",
               &mistakes);
      break;
  }
  return mistakes;
}

}  // namespace

std::string ExplainMissingBoard(const cv::Mat& grey, const Board& board) {
  for (const Mistake& mistake : Mistakes(board)) {
    try {
      mistake.meant.Check();
    } catch (const base::InputError&) {
      continue;  // no such board
    }
    if (DetectBoard(grey, mistake.meant).ok()) {
      return fmt::format("in sight is {}: {}", mistake.meant.Text(), mistake.explanation);
    }
  }
  return "";
}

}  // namespace softforce::vision
