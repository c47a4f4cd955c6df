#include "softforce/vision/board.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "softforce/base/input_error.h"
#include "softforce/vision/tag_cells.h"
#include "vision/marker_dictionary.h"

namespace softforce::vision {
namespace {

constexpr int kMostCells = 100;  // along a side

// Throws InputErrors that show the board's own entry.
class Checker {
 public:
  explicit Checker(std::string where) : where_(std::move(where)) {}

  void Length(const char* entry, double metres) const {
    if (std::isfinite(metres) && metres > 0) return;
    throw base::InputError(where_, fmt::format("{} is {:g} mm, must be > 0", entry, 1e3 * metres));
  }
  void Smaller(const char* small, double small_m, const char* large, double large_m) const {
    if (small_m < large_m) return;
    throw base::InputError(where_, fmt::format("{} ({:g} mm) must be smaller than {} ({:g} mm)",
                                               small, 1e3 * small_m, large, 1e3 * large_m));
  }
  void Cells(const char* what, int columns, int rows, int min_columns, int min_rows) const {
    if (columns >= min_columns && rows >= min_rows && columns <= kMostCells && rows <= kMostCells) {
      return;
    }
    throw base::InputError(where_,
                           fmt::format("has {}x{} {}, expected {}x{} to {}x{}", columns, rows, what,
                                       min_columns, min_rows, kMostCells, kMostCells));
  }

 private:
  std::string where_;
};

void CheckCharuco(const Board& board, const Checker& checker) {
  checker.Cells("squares", board.columns, board.rows, 3, 3);
  checker.Length("square", board.square);
  checker.Length("marker", board.marker);
  checker.Smaller("marker", board.marker, "square", board.square);
  const int available = MarkersIn(board.dictionary, "charuco: dictionary");
  const int needed = board.columns * board.rows / 2;
  if (needed > available) {
    throw base::InputError(
        "charuco",
        fmt::format("{}x{} squares carry {} markers, but dictionary {} has {}", board.columns,
                    board.rows, needed, board.dictionary, available),
        "Take a larger dictionary, as 4X4_100, or fewer squares.");
  }
}

void CheckAprilGrid(const Board& board, const Checker& checker) {
  checker.Cells("tags", board.columns, board.rows, 1, 1);
  if (board.columns * board.rows < 2) {
    throw base::InputError("aprilgrid", "has one tag only, expected at least 2");
  }
  checker.Length("tag", board.tag);
  if (!(board.gap_ratio > 0 && board.gap_ratio <= 1)) {
    throw base::InputError(
        "aprilgrid", fmt::format("spacing is {:g}, must be > 0 and at most 1", board.gap_ratio),
        "It is the gap between two tags divided by a tag's side, as Kalibr's tagSpacing.");
  }
  if (board.family == "tagStandard41h12") {
    throw base::InputError("aprilgrid", "family tagStandard41h12 has a white border",
                           "Take tag36h11, tag25h9 or tag16h5, whose border is black.");
  }
  DrawTag(board.family, board.first_tag, "aprilgrid: family");  // throws for unknown ones
  DrawTag(
      board.family, board.first_tag + board.columns * board.rows - 1,
      fmt::format("aprilgrid: {}x{} tags from {} on", board.columns, board.rows, board.first_tag));
}

}  // namespace

void Board::Check() const {
  switch (kind) {
    case Kind::kChessboard: {
      const Checker checker("chessboard");
      checker.Cells("inner corners", columns, rows, 3, 3);
      checker.Length("square", square);
      return;
    }
    case Kind::kCharuco:
      return CheckCharuco(*this, Checker("charuco"));
    case Kind::kAprilGrid:
      return CheckAprilGrid(*this, Checker("aprilgrid"));
    case Kind::kCircles: {
      const Checker checker("circles");
      checker.Cells("circles in a row and rows", columns, rows, 2, 3);
      checker.Length("spacing", spacing);
      checker.Length("diameter", diameter);
      checker.Smaller("diameter", diameter, "the circles' distance", CellSize());
      return;
    }
  }
}

int Board::point_columns() const {
  if (kind == Kind::kCharuco) return columns - 1;
  return kind == Kind::kAprilGrid ? 2 * columns : columns;
}

int Board::point_rows() const {
  if (kind == Kind::kCharuco) return rows - 1;
  return kind == Kind::kAprilGrid ? 2 * rows : rows;
}

Eigen::Vector3d Board::Point(int id) const {
  assert(id >= 0 && id < NumPoints());
  const int i = id / point_columns(), j = id % point_columns();
  switch (kind) {
    case Kind::kChessboard:
      return {j * square, i * square, 0};
    case Kind::kCharuco:
      return {(j + 1) * square, (i + 1) * square, 0};
    case Kind::kAprilGrid: {
      const double pitch = tag * (1 + gap_ratio);
      return {j / 2 * pitch + j % 2 * tag, i / 2 * pitch + i % 2 * tag, 0};
    }
    case Kind::kCircles:
      return {(2 * j + i % 2) * spacing, i * spacing, 0};
  }
  return {};
}

std::vector<Eigen::Vector3d> Board::Points() const {
  std::vector<Eigen::Vector3d> points;
  for (int id = 0; id < NumPoints(); ++id) points.push_back(Point(id));
  return points;
}

double Board::CellSize() const {
  if (kind == Kind::kAprilGrid) return tag;
  return kind == Kind::kCircles ? M_SQRT2 * spacing : square;
}

bool Board::LooksAlikeWhenTurned() const {
  if (kind == Kind::kChessboard) return (columns + rows) % 2 == 0;
  return kind == Kind::kCircles && rows % 2 == 0;
}

}  // namespace softforce::vision
