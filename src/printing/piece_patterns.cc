#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printing/pattern.h"
#include "softforce/base/input_error.h"
#include "softforce/vision/tag_cells.h"

namespace softforce::printing {
namespace {

constexpr double kMm = 1e-3;
constexpr double kCutLine = 0.1 * kMm;

// Pieces to cut out, in rows and columns.
struct Grid {
  int columns, count;
  double width, height;  // m, of one piece

  Eigen::Vector2d Corner(int piece) const {
    return {piece % columns * width, piece / columns * height};
  }
  int rows() const { return (count + columns - 1) / columns; }
};

Grid Arrange(const char* what, double width, double height, int wanted,
             const Eigen::Vector2d& room) {
  constexpr double kRounding = 1e-9;  // m
  const int columns = static_cast<int>((room.x() + kRounding) / width);
  const int rows = static_cast<int>((room.y() + kRounding) / height);
  const int fitting = std::max(columns, 0) * std::max(rows, 0);
  if (fitting == 0) {
    throw base::InputError(
        what,
        fmt::format("one piece takes {:.4g} x {:.4g} mm, the paper leaves {:.4g} x {:.4g} mm",
                    width / kMm, height / kMm, room.x() / kMm, room.y() / kMm),
        "Take a smaller size or larger paper, as --paper A3.");
  }
  if (wanted > fitting) {
    throw base::InputError(
        what,
        fmt::format("{} pieces of {:.4g} x {:.4g} mm do not fit on the paper", wanted, width / kMm,
                    height / kMm),
        fmt::format("At most {} do; print more sheets, or take larger paper.", fitting));
  }
  return {columns, wanted > 0 ? wanted : fitting, width, height};
}

// Light lines between the pieces and around them.
Pattern CutLines(const Grid& grid) {
  const int columns = std::min(grid.columns, grid.count);
  Pattern pattern{columns * grid.width, grid.rows() * grid.height, 0, {}};
  for (int j = 0; j <= columns; ++j) {
    pattern.ink.lines.push_back(
        {{j * grid.width, 0}, {j * grid.width, pattern.height}, kCutLine, true});
  }
  for (int i = 0; i <= grid.rows(); ++i) {
    pattern.ink.lines.push_back(
        {{0, i * grid.height}, {pattern.width, i * grid.height}, kCutLine, true});
  }
  return pattern;
}

}  // namespace

Pattern DrawTags(const TagsTarget& target, const Eigen::Vector2d& room, int* drawn) {
  const vision::TagCells any = vision::DrawTag(target.family, target.first, "tags: family");
  const double cell = target.size / (any.cells.cols - 2 * any.margin);
  const double whole = cell * any.cells.cols;  // with what the family draws outside the corners
  const double rim = std::max(cell, 2 * kMm);  // white, up to the cut
  const double label = std::max(3 * kMm, 0.1 * whole);
  int wanted = target.count;
  Grid grid = Arrange("tags", whole + 2 * rim, whole + 2 * rim + label, wanted, room);
  if (wanted == 0) {  // as many as fit, but no more than there are
    while (grid.count > 1) {
      try {
        vision::DrawTag(target.family, target.first + grid.count - 1);
        break;
      } catch (const base::InputError&) {
        --grid.count;
      }
    }
  }
  Pattern pattern = CutLines(grid);
  for (int piece = 0; piece < grid.count; ++piece) {
    const int id = target.first + piece;
    const vision::TagCells tag = vision::DrawTag(target.family, id, "tags");
    const Eigen::Vector2d corner = grid.Corner(piece) + Eigen::Vector2d(rim, rim);
    for (int i = 0; i < tag.cells.rows; ++i) {
      for (int j = 0; j < tag.cells.cols; ++j) {
        if (tag.cells(i, j) != 0) continue;
        const Eigen::Vector2d at = corner + cell * Eigen::Vector2d(j, i);
        pattern.ink.black.emplace_back(at, at + Eigen::Vector2d(cell, cell));
      }
    }
    pattern.ink.texts.push_back(
        {fmt::format("{} id {}  {:.4g} mm", target.family, id, target.size / kMm),
         corner + Eigen::Vector2d(0.5 * whole, whole + rim + 0.5 * label), 0.7 * label, whole,
         Sheet::Text::Anchor::kMiddle});
  }
  *drawn = grid.count;
  return pattern;
}

Pattern DrawMarkers(const MarkersTarget& target, const Eigen::Vector2d& room, int* drawn) {
  const double side = target.diameter + 2 * target.rim;
  const Grid grid = Arrange("markers", side, side, target.count, room);
  Pattern pattern = CutLines(grid);
  for (int piece = 0; piece < grid.count; ++piece) {
    const Eigen::Vector2d corner = grid.Corner(piece);
    const Eigen::Vector2d opposite = corner + Eigen::Vector2d(side, side);
    if (target.white) pattern.ink.black.emplace_back(corner, opposite);
    pattern.ink.discs.push_back({0.5 * (corner + opposite), target.diameter, target.white});
  }
  *drawn = grid.count;
  return pattern;
}

}  // namespace softforce::printing
