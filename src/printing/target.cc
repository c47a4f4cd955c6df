#include "softforce/printing/target.h"

#include <fmt/format.h>

#include <cmath>

#include "printing/pattern.h"
#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"

namespace softforce::printing {
namespace {

using base::Dimension;
using base::InputError;
using vision::Board;

constexpr double kMm = 1e-3;

// What the kind alone stands for; each fits on A4 and on Letter.
constexpr std::pair<const char*, const char*> kDefaults[] = {
    {"chessboard", "chessboard:9x6,square=20mm"},
    {"charuco", "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50"},
    {"aprilgrid", "aprilgrid:6x6,tag=24mm,spacing=0.3"},
    {"circles", "circles:4x11,spacing=20mm,diameter=14mm"},
};

void RequirePositive(const std::string& where, const char* entry, double metres) {
  if (std::isfinite(metres) && metres > 0) return;
  throw InputError(where, fmt::format("{} is {:g} mm, must be > 0", entry, metres / kMm));
}

TagsTarget ParseTags(const std::string& text, const std::string& where) {
  base::Entries entries(text, where, "Write for example tags:family=tag36h11,size=30mm,count=4.");
  TagsTarget tags;
  tags.family = entries.Take("family", tags.family);
  tags.size = entries.TakeQuantity("size", Dimension::kLength, "30 mm");
  tags.first = entries.TakeCount("first", "0");
  tags.count = entries.TakeCount("count", "0");
  entries.RefuseRest("family, size, first, count");
  RequirePositive(where, "size", tags.size);
  return tags;
}

MarkersTarget ParseMarkers(const std::string& text, const std::string& where) {
  base::Entries entries(text, where, "Write for example markers:size=6mm,count=40.");
  MarkersTarget markers;
  markers.diameter = entries.TakeQuantity("size", Dimension::kLength, "6 mm");
  markers.rim = entries.TakeQuantity("rim", Dimension::kLength, "2 mm");
  markers.count = entries.TakeCount("count", "0");
  markers.white = entries.TakeFlag("white");
  entries.RefuseRest("size, rim, count, white");
  RequirePositive(where, "size", markers.diameter);
  RequirePositive(where, "rim", markers.rim);
  return markers;
}

// Takes ",border=2" out of an AprilGrid's text, which is of its print, not of the board.
int TakeBorder(std::string* text, const std::string& where) {
  const size_t at = base::LowerCase(*text).find("border");
  if (at == std::string::npos || base::LowerCase(*text).rfind("aprilgrid", 0) != 0) return 1;
  const size_t end = std::min(text->find(',', at), text->size());
  base::Entries entry(text->substr(at, end - at), where, "Write for example border=2.");
  const int border = entry.TakeCount("border");
  if (border != 1 && border != 2) {
    throw InputError(where, fmt::format("border is {}, expected 1 or 2 cells", border),
                     "1: AprilTag, OpenCV and softforce read it; 2: Kalibr and softforce do.");
  }
  text->erase(at, end - at);
  return border;
}

double* BaseLength(Board* board) {
  if (board->kind == Board::Kind::kAprilGrid) return &board->tag;
  return board->kind == Board::Kind::kCircles ? &board->spacing : &board->square;
}

// The same board with all lengths times `scale`.
Board Scaled(Board board, double scale) {
  for (double* length :
       {&board.square, &board.marker, &board.tag, &board.spacing, &board.diameter}) {
    *length *= scale;
  }
  return board;
}

bool Fits(const Pattern& pattern, const Paper& paper, const SheetOptions& options) {
  constexpr double kRounding = 1e-9;  // m
  const Eigen::Vector2d room = Room(paper, options, pattern.quiet);
  return pattern.width <= room.x() + kRounding && pattern.height <= room.y() + kRounding;
}

// The largest board of the same shape, in tenths of a millimetre of its base length; empty if none.
std::string LargestThatFits(const BoardTarget& target, const std::vector<Paper>& papers,
                            const SheetOptions& options) {
  BoardTarget smaller = target;
  const double length = *BaseLength(&smaller.board);
  for (double tenths = std::floor(length / (0.1 * kMm)); tenths >= 5; --tenths) {
    smaller.board = Scaled(target.board, tenths * 0.1 * kMm / length);
    for (const Paper& paper : papers) {
      if (Fits(DrawBoard(smaller), paper, options)) {
        return fmt::format("{} on {}", smaller.board.Text(), paper.name);
      }
    }
  }
  return "";
}

Sheet DrawBoardSheet(const BoardTarget& target, const SheetOptions& options) {
  const Pattern pattern = DrawBoard(target);
  const std::vector<Paper> papers = AllowedPapers(options);
  const std::string text = target.board.Text();
  for (const Paper& paper : papers) {
    if (!Fits(pattern, paper, options)) continue;
    return Compose(
        pattern, paper, options,
        fmt::format("{} on {}. Print at 100 % and check the ruler.", TextOf(target), paper.name),
        fmt::format("softforce calibrate --board {}", text));
  }
  const std::string largest = LargestThatFits(target, papers, options);
  const Eigen::Vector2d room = Room(papers.back(), options, pattern.quiet);
  throw InputError(
      text,
      fmt::format("the pattern is {:.4g} x {:.4g} mm, {} leaves {:.4g} x {:.4g} mm inside its "
                  "margins and above the ruler",
                  pattern.width / kMm, pattern.height / kMm, papers.back().name, room.x() / kMm,
                  room.y() / kMm),
      largest.empty() ? "Take larger paper or fewer cells."
                      : "The largest of this shape that fits: " + largest + ".");
}

// Takes the paper on which more pieces fit.
template <typename Draw>
Sheet DrawPieces(const SheetOptions& options, const std::string& usage, const Draw& draw) {
  std::optional<Sheet> best;
  std::optional<InputError> refusal;
  int most = 0;
  for (const Paper& paper : AllowedPapers(options)) {
    try {
      int drawn = 0;
      const Pattern pattern = draw(Room(paper, options, 0), &drawn);
      if (drawn <= most) continue;
      most = drawn;
      best =
          Compose(pattern, paper, options,
                  fmt::format("{} on {}. Print at 100 % and check the ruler.", usage, paper.name),
                  "Cut along the light lines.");
    } catch (const InputError& error) {
      if (!refusal) refusal = error;
    }
  }
  if (!best) throw *refusal;
  return *best;
}

}  // namespace

const char* const kTargetHelp =
    "  chessboard:9x6,square=20mm                               9x6 INNER corners (10x7 squares)\n"
    "  charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50   7x10 SQUARES\n"
    "  aprilgrid:6x6,tag=24mm,spacing=0.3                       6x6 tags, Kalibr's layout; "
    "border=2\n"
    "                                                           for Kalibr's own programs\n"
    "  circles:4x11,spacing=20mm,diameter=14mm                  asymmetric circles\n"
    "  tags:family=tag36h11,size=30mm,first=0,count=4           single tags to cut out: tag36h11,\n"
    "                                                           tag25h9, tag16h5, "
    "tagStandard41h12\n"
    "  markers:size=6mm,rim=2mm,count=40                        dots for the body, to cut out;\n"
    "                                                           add ,white for white on black\n"
    "  The kind alone (\"charuco\") takes the values shown; tags and markers fill the sheet.\n";

Target ParseTarget(const std::string& text, const std::string& where) {
  const std::string trimmed = base::Trimmed(text);
  const size_t colon = std::min(trimmed.find(':'), trimmed.size());
  const std::string kind = base::LowerCase(base::Trimmed(trimmed.substr(0, colon)));
  const std::string rest = trimmed.substr(std::min(colon + 1, trimmed.size()));
  if (kind == "tags") return ParseTags(rest, where);
  if (kind == "markers") return ParseMarkers(rest, where);
  std::string board = trimmed;
  bool known = trimmed.find(".y") != std::string::npos;  // a file of Kalibr
  for (const auto& [name, standard] : kDefaults) {
    if (kind != name) continue;
    known = true;
    if (base::Trimmed(rest).empty()) board = standard;
  }
  if (!known) {
    throw InputError(where,
                     fmt::format("\"{}\" is no kind of target; expected chessboard, charuco, "
                                 "aprilgrid, circles, tags or markers",
                                 kind),
                     std::string("Targets are written as:\n") + kTargetHelp);
  }
  BoardTarget target;
  target.black_border = TakeBorder(&board, where);
  target.board = vision::ParseBoard(board, where);
  return target;
}

std::string TextOf(const Target& target) {
  if (const auto* board = std::get_if<BoardTarget>(&target)) {
    return board->board.Text() + (board->black_border == 2 ? ",border=2" : "");
  }
  if (const auto* tags = std::get_if<TagsTarget>(&target)) {
    std::string text = fmt::format("tags:family={},size={:.9g}mm", tags->family, tags->size / kMm);
    if (tags->first > 0) text += fmt::format(",first={}", tags->first);
    return tags->count > 0 ? text + fmt::format(",count={}", tags->count) : text;
  }
  const auto& markers = std::get<MarkersTarget>(target);
  std::string text =
      fmt::format("markers:size={:.9g}mm,rim={:.9g}mm", markers.diameter / kMm, markers.rim / kMm);
  if (markers.count > 0) text += fmt::format(",count={}", markers.count);
  return markers.white ? text + ",white" : text;
}

Sheet DrawTarget(const Target& target, const SheetOptions& options) {
  options.Check();
  if (const auto* board = std::get_if<BoardTarget>(&target)) {
    return DrawBoardSheet(*board, options);
  }
  const std::string what = TextOf(target);
  return DrawPieces(options, what, [&](const Eigen::Vector2d& room, int* drawn) {
    if (const auto* tags = std::get_if<TagsTarget>(&target)) return DrawTags(*tags, room, drawn);
    return DrawMarkers(std::get<MarkersTarget>(target), room, drawn);
  });
}

}  // namespace softforce::printing
