#pragma once

#include <optional>
#include <string>

#include "softforce/printing/sheet.h"
#include "softforce/printing/target.h"

namespace softforce::printing {

// What is to be measured or cut out, in metres from its own top left corner; `ink` has no paper
// yet.
struct Pattern {
  double width = 0, height = 0;
  double quiet = 0;  // m of white around it, so that detectors see where it ends
  Sheet ink;
};

Pattern DrawBoard(const BoardTarget& target);

// Paper with what is printed around the pattern.
struct Paper {
  std::string name;  // "A4 landscape"
  double width, height;
};

// The papers that the options allow, in the order of preference.
std::vector<Paper> AllowedPapers(const SheetOptions& options);

// Room for a pattern between the margins and above the ruler, m.
Eigen::Vector2d Room(const Paper& paper, const SheetOptions& options, double quiet);

// The pattern in the middle of its room, with the ruler and the lines of text below.
Sheet Compose(const Pattern& pattern, const Paper& paper, const SheetOptions& options,
              const std::string& title, const std::string& usage);

// Sheets of single pieces, side by side. Throw InputError if there is no room.
Pattern DrawTags(const TagsTarget& target, const Eigen::Vector2d& room, int* drawn);
Pattern DrawMarkers(const MarkersTarget& target, const Eigen::Vector2d& room, int* drawn);

}  // namespace softforce::printing
