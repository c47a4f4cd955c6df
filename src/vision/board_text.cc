#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/vision/board.h"
#include "vision/kalibr_target.h"

namespace softforce::vision {
namespace {

using base::Dimension;
using base::InputError;

// What is written for each kind; the order is that of Board::Kind.
struct Spelling {
  const char* kind;
  const char* cells;    // what columns x rows counts
  const char* entries;  // known keys; optional ones in brackets
  const char* example;
};

constexpr Spelling kSpellings[] = {
    {"chessboard", "INNER corners, one fewer than squares in each direction", "square",
     "chessboard:9x6,square=20mm"},
    {"charuco", "SQUARES (not inner corners)", "square, marker, dictionary, [legacy]",
     "charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50"},
    {"aprilgrid", "tags", "tag, spacing, [family], [first]", "aprilgrid:6x6,tag=24mm,spacing=0.3"},
    {"circles", "circles in a row x rows", "spacing, diameter",
     "circles:4x11,spacing=20mm,diameter=14mm"},
};

const Spelling& SpellingOf(Board::Kind kind) { return kSpellings[static_cast<int>(kind)]; }

std::string HowToWrite(const Spelling& spelling) {
  return fmt::format("Write for example {}: {} counts {}.", spelling.example, spelling.kind,
                     spelling.cells);
}

Board::Kind KindOf(const std::string& name, const std::string& where) {
  for (int i = 0; i < static_cast<int>(std::size(kSpellings)); ++i) {
    if (name == kSpellings[i].kind) return static_cast<Board::Kind>(i);
  }
  throw InputError(where,
                   fmt::format("\"{}\" is no kind of board; expected chessboard, charuco, "
                               "aprilgrid or circles, or a file that ends in .yaml",
                               name),
                   std::string("Boards are written as:\n") + kBoardHelp);
}

// "9x6", also "9 X 6".
std::optional<std::pair<int, int>> ReadCells(const std::string& text) {
  const size_t x = base::LowerCase(text).find('x');
  if (x == std::string::npos) return std::nullopt;
  const auto number = [](const std::string& digits) {
    int value = -1;
    const char* end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, value);
    return read.ec == std::errc() && read.ptr == end ? value : -1;
  };
  const int columns = number(base::Trimmed(text.substr(0, x)));
  const int rows = number(base::Trimmed(text.substr(x + 1)));
  if (columns < 0 || rows < 0) return std::nullopt;
  return std::make_pair(columns, rows);
}

std::string DictionaryName(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const char* prefix : {"DICT_", "ARUCO_"}) {
    if (name.rfind(prefix, 0) == 0) name = name.substr(std::string(prefix).size());
  }
  return name;
}

// A gap over the tag's side, or the gap itself as a length.
double GapRatio(const std::string& text, double tag, const std::string& where) {
  if (text.find_first_of("mu\u00b5") == std::string::npos) {
    return base::ParseQuantity(text, Dimension::kNumber, 1, where)[0];
  }
  return base::ParseQuantity(text, Dimension::kLength, 1, where)[0] / tag;
}

void TakeEntries(base::Entries* entries, const std::string& where, Board* board) {
  switch (board->kind) {
    case Board::Kind::kChessboard:
      board->square = entries->TakeQuantity("square", Dimension::kLength);
      return;
    case Board::Kind::kCharuco:
      board->square = entries->TakeQuantity("square", Dimension::kLength);
      board->marker = entries->TakeQuantity("marker", Dimension::kLength);
      board->dictionary = DictionaryName(entries->Take("dictionary"));
      board->legacy = entries->TakeFlag("legacy");
      return;
    case Board::Kind::kAprilGrid:
      board->tag = entries->TakeQuantity("tag", Dimension::kLength);
      board->gap_ratio = GapRatio(entries->Take("spacing"), board->tag, where + ": spacing");
      board->family = entries->Take("family", "tag36h11");
      board->first_tag = entries->TakeCount("first", "0");
      return;
    case Board::Kind::kCircles:
      board->spacing = entries->TakeQuantity("spacing", Dimension::kLength);
      board->diameter = entries->TakeQuantity("diameter", Dimension::kLength);
      return;
  }
}

std::string Millimetres(double metres) { return fmt::format("{:.9g}mm", 1e3 * metres); }

}  // namespace

const char* const kBoardHelp =
    "  chessboard:9x6,square=20mm                               9x6 INNER corners (10x7 squares)\n"
    "  charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50   7x10 SQUARES; add ,legacy for a\n"
    "                                                           board drawn by OpenCV before 4.6\n"
    "  aprilgrid:6x6,tag=24mm,spacing=0.3                       6x6 tags, Kalibr's layout; also\n"
    "                                                           family=tag36h11, first=0\n"
    "  circles:4x11,spacing=20mm,diameter=14mm                  OpenCV's asymmetric circles: 4 in\n"
    "                                                           each of 11 rows, 20 mm apart\n"
    "  target.yaml                                              a target file of Kalibr\n";

Board ParseBoard(const std::string& text, const std::string& where) {
  const std::string trimmed = base::Trimmed(text);
  const std::string lower = base::LowerCase(trimmed);
  for (const char* ending : {".yaml", ".yml"}) {
    const size_t length = std::string(ending).size();
    if (lower.size() > length && lower.compare(lower.size() - length, length, ending) == 0) {
      return ReadKalibrTarget(trimmed);
    }
  }
  const size_t colon = std::min(trimmed.find(':'), trimmed.size());
  Board board;
  board.kind = KindOf(base::Trimmed(lower.substr(0, colon)), where);
  const Spelling& spelling = SpellingOf(board.kind);
  const std::string rest = trimmed.substr(std::min(colon + 1, trimmed.size()));
  const size_t comma = std::min(rest.find(','), rest.size());
  const std::string cells = base::Trimmed(rest.substr(0, comma));
  const auto counted = ReadCells(cells);
  if (!counted) {
    throw InputError(where,
                     fmt::format("got \"{}\" where {} expects columns x rows, as {}", cells,
                                 spelling.kind, "9x6"),
                     HowToWrite(spelling));
  }
  std::tie(board.columns, board.rows) = *counted;
  base::Entries entries(rest.substr(std::min(comma + 1, rest.size())), where, HowToWrite(spelling));
  TakeEntries(&entries, where, &board);
  entries.RefuseRest(spelling.entries);
  try {
    board.Check();
  } catch (const InputError& error) {
    throw InputError(where, error.what(), HowToWrite(spelling));
  }
  return board;
}

std::string Board::Text() const {
  std::string text = fmt::format("{}:{}x{}", SpellingOf(kind).kind, columns, rows);
  switch (kind) {
    case Kind::kChessboard:
      return text + ",square=" + Millimetres(square);
    case Kind::kCharuco:
      return text + fmt::format(",square={},marker={},dictionary={}{}", Millimetres(square),
                                Millimetres(marker), dictionary, legacy ? ",legacy" : "");
    case Kind::kAprilGrid:
      text += fmt::format(",tag={},spacing={:.9g}", Millimetres(tag), gap_ratio);
      if (family != "tag36h11") text += ",family=" + family;
      if (first_tag != 0) text += fmt::format(",first={}", first_tag);
      return text;
    case Kind::kCircles:
      return text +
             fmt::format(",spacing={},diameter={}", Millimetres(spacing), Millimetres(diameter));
  }
  return text;
}

}  // namespace softforce::vision
