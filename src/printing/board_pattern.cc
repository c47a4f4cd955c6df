#include "printing/pattern.h"
#include "softforce/vision/marker_cells.h"
#include "softforce/vision/tag_cells.h"

namespace softforce::printing {
namespace {

using vision::Board;

void AddBox(double x, double y, double width, double height, Sheet* ink) {
  ink->black.emplace_back(Eigen::Vector2d(x, y), Eigen::Vector2d(x + width, y + height));
}

// Black cells of one row that follow each other become one rectangle.
void AddCells(const cv::Mat1b& cells, double x, double y, double side, Sheet* ink) {
  const double cell = side / cells.cols;
  for (int i = 0; i < cells.rows; ++i) {
    for (int j = 0; j < cells.cols; ++j) {
      if (cells(i, j) != 0) continue;
      int end = j;
      while (end < cells.cols && cells(i, end) == 0) ++end;
      AddBox(x + j * cell, y + i * cell, (end - j) * cell, cell, ink);
      j = end;
    }
  }
}

Pattern Chessboard(const Board& board) {
  Pattern pattern{
      (board.columns + 1) * board.square, (board.rows + 1) * board.square, 0.5 * board.square, {}};
  for (int i = 0; i <= board.rows; ++i) {
    for (int j = i % 2; j <= board.columns; j += 2) {
      AddBox(j * board.square, i * board.square, board.square, board.square, &pattern.ink);
    }
  }
  return pattern;
}

Pattern Charuco(const Board& board) {
  const double square = board.square, margin = 0.5 * (board.square - board.marker);
  Pattern pattern{board.columns * square, board.rows * square, 0.25 * square, {}};
  const int first_black = board.legacy && board.rows % 2 == 0 ? 1 : 0;
  int id = 0;
  for (int i = 0; i < board.rows; ++i) {
    for (int j = 0; j < board.columns; ++j) {
      if ((i + j) % 2 == first_black) {
        AddBox(j * square, i * square, square, square, &pattern.ink);
      } else {
        AddCells(vision::DrawMarker(board.dictionary, id++), j * square + margin,
                 i * square + margin, board.marker, &pattern.ink);
      }
    }
  }
  return pattern;
}

// Kalibr's layout: rows count upwards, tags stand turned by half a turn against OpenCV's way, and
// small black squares touch their corners.
Pattern AprilGrid(const BoardTarget& target) {
  const Board& board = target.board;
  const double gap = board.tag * board.gap_ratio, pitch = board.tag + gap;
  Pattern pattern{board.columns * pitch + gap, board.rows * pitch + gap, gap, {}};
  for (int i = 0; i <= board.rows; ++i) {
    for (int j = 0; j <= board.columns; ++j) {
      AddBox(j * pitch, i * pitch, gap, gap, &pattern.ink);
      if (i == board.rows || j == board.columns) continue;
      const int id = board.first_tag + (board.rows - 1 - i) * board.columns + j;
      const vision::TagCells tag =
          vision::DrawTag(board.family, id, "aprilgrid", target.black_border);
      const int count = tag.cells.cols - 2 * tag.margin;
      cv::Mat1b cells = tag.cells(cv::Rect(tag.margin, tag.margin, count, count)).clone();
      cv::flip(cells, cells, -1);  // by half a turn
      AddCells(cells, j * pitch + gap, i * pitch + gap, board.tag, &pattern.ink);
    }
  }
  return pattern;
}

Pattern Circles(const Board& board) {
  const double radius = 0.5 * board.diameter;
  Pattern pattern{(2 * board.columns - 1) * board.spacing + board.diameter,
                  (board.rows - 1) * board.spacing + board.diameter,
                  0.5 * board.spacing,
                  {}};
  for (const Eigen::Vector3d& point : board.Points()) {
    pattern.ink.discs.push_back(
        {point.head<2>() + Eigen::Vector2d(radius, radius), board.diameter});
  }
  return pattern;
}

}  // namespace

Pattern DrawBoard(const BoardTarget& target) {
  switch (target.board.kind) {
    case Board::Kind::kChessboard:
      return Chessboard(target.board);
    case Board::Kind::kCharuco:
      return Charuco(target.board);
    case Board::Kind::kAprilGrid:
      return AprilGrid(target);
    case Board::Kind::kCircles:
      return Circles(target.board);
  }
  return {};
}

}  // namespace softforce::printing
