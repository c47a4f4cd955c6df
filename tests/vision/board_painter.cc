#include "vision/board_painter.h"

#include <cmath>
#include <map>
#include <opencv2/aruco.hpp>
#include <string>
#include <tuple>

#include "softforce/vision/tag_cells.h"

namespace softforce::testing {
namespace {

using vision::Board;

bool InSquare(const Eigen::Vector2d& p, double side) {
  return p.minCoeff() >= 0 && p.maxCoeff() < side;
}

// Black cells of marker `id` with its black border, row by row from the top.
const cv::Mat1b& MarkerCells(int id) {
  static std::map<int, cv::Mat1b> drawn;
  cv::Mat1b& cells = drawn[id];
  if (cells.empty()) {
    const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
    cv::aruco::drawMarker(dictionary, id, 6, cells);
  }
  return cells;
}

bool CharucoInk(const Board& board, const Eigen::Vector2d& place) {
  const int j = static_cast<int>(std::floor(place.x() / board.square));
  const int i = static_cast<int>(std::floor(place.y() / board.square));
  if (i < 0 || j < 0 || i >= board.rows || j >= board.columns) return false;
  const bool swapped = board.legacy && board.rows % 2 == 0;
  const auto is_black = [&](int row, int column) { return ((row + column) % 2 == 0) != swapped; };
  if (is_black(i, j)) return true;
  int id = 0;
  for (int k = 0; k < i * board.columns + j; ++k) {
    id += is_black(k / board.columns, k % board.columns) ? 0 : 1;
  }
  const double margin = 0.5 * (board.square - board.marker);
  const Eigen::Vector2d p =
      place - Eigen::Vector2d(j * board.square + margin, i * board.square + margin);
  if (!InSquare(p, board.marker)) return false;
  const double cell = board.marker / 6;
  return MarkerCells(id)(static_cast<int>(p.y() / cell), static_cast<int>(p.x() / cell)) == 0;
}

bool AprilGridInk(const PrintedBoard& printed, const Eigen::Vector2d& place) {
  static std::map<std::tuple<std::string, int, int>, vision::TagCells> drawn;
  const Board& board = printed.board;
  const double gap = board.tag * board.gap_ratio, pitch = board.tag + gap;
  const int j = static_cast<int>(std::floor((place.x() + gap) / pitch));
  const int i = static_cast<int>(std::floor((place.y() + gap) / pitch));
  const Eigen::Vector2d p = place - pitch * Eigen::Vector2d(j, i);  // from the tag's corner
  if (i < 0 || j < 0 || i > board.rows || j > board.columns) return false;
  if (p.maxCoeff() < 0) return true;  // the small black square at its lower left
  if (i == board.rows || j == board.columns || !InSquare(p, board.tag)) return false;
  const int id = board.first_tag + i * board.columns + j;
  vision::TagCells& tag = drawn[{board.family, id, printed.black_border}];
  if (tag.cells.empty()) tag = vision::DrawTag(board.family, id, "test", printed.black_border);
  const int count = tag.cells.cols - 2 * tag.margin;
  const double cell = board.tag / count;
  int row = count - 1 - static_cast<int>(p.y() / cell), column = static_cast<int>(p.x() / cell);
  if (!printed.tags_upright) {
    row = count - 1 - row;
    column = count - 1 - column;
  }
  return tag.cells(tag.margin + row, tag.margin + column) == 0;
}

bool CirclesInk(const Board& board, const Eigen::Vector2d& place) {
  for (const Eigen::Vector3d& centre : board.Points()) {
    if ((centre.head<2>() - place).norm() < 0.5 * board.diameter) return true;
  }
  return false;
}

}  // namespace

bool HasInk(const PrintedBoard& printed, const Eigen::Vector2d& place) {
  const Board& board = printed.board;
  switch (board.kind) {
    case Board::Kind::kChessboard: {
      const int j = static_cast<int>(std::floor(place.x() / board.square));
      const int i = static_cast<int>(std::floor(place.y() / board.square));
      if (i < -1 || j < -1 || i >= board.rows || j >= board.columns) return false;
      return ((i + j) % 2 == 0) != printed.top_left_white;
    }
    case Board::Kind::kCharuco:
      return CharucoInk(board, place);
    case Board::Kind::kAprilGrid:
      return AprilGridInk(printed, place);
    case Board::Kind::kCircles:
      return CirclesInk(board, place);
  }
  return false;
}

Eigen::Vector2d BoardSight::Pixel(const Eigen::Vector3d& point) const {
  return (pixel_from_board * point.head<2>().homogeneous()).hnormalized();
}

BoardSight LookAt(const vision::Board& board, const Eigen::Vector2d& middle, double scale,
                  const Eigen::Matrix3d& rotation) {
  constexpr double kFocal = 1000;  // px
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : board.Points()) centre += point / board.NumPoints();
  Eigen::Matrix3d facing = Eigen::Matrix3d::Identity();
  if (board.kind == Board::Kind::kAprilGrid) facing.diagonal() = Eigen::Vector3d(1, -1, -1);
  const Eigen::Matrix3d R = rotation * facing;
  const Eigen::Vector3d t = Eigen::Vector3d(0, 0, kFocal / scale) - R * centre;
  Eigen::Matrix3d K;
  K << kFocal, 0, middle.x(), 0, kFocal, middle.y(), 0, 0, 1;
  Eigen::Matrix3d pose;
  pose << R.col(0), R.col(1), t;
  return {K * pose};
}

void PaintBoard(const PrintedBoard& printed, const BoardSight& sight, SyntheticScene* scene) {
  constexpr double kInk = 30, kPaper = 210;  // grey levels
  const double margin = 1.6 * printed.board.CellSize();
  Eigen::AlignedBox2d paper, seen;
  for (const Eigen::Vector3d& point : printed.board.Points()) {
    paper.extend(Eigen::Vector2d(point.head<2>().array() - margin));
    paper.extend(Eigen::Vector2d(point.head<2>().array() + margin));
  }
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d at = paper.corner(static_cast<Eigen::AlignedBox2d::CornerType>(k));
    seen.extend(sight.Pixel({at.x(), at.y(), 0}));
  }
  const Eigen::Matrix3d board_from_pixel = sight.pixel_from_board.inverse();
  scene->Paint(seen.center(), 0.5 * seen.sizes().maxCoeff() + 2,
               [&](const Eigen::Vector2d& p) -> double {
                 const Eigen::Vector2d place = (board_from_pixel * p.homogeneous()).hnormalized();
                 if (!paper.contains(place)) return NAN;
                 return HasInk(printed, place) ? kInk : kPaper;
               });
}

}  // namespace softforce::testing
