#pragma once

#include <string>
#include <variant>

#include "softforce/printing/sheet.h"
#include "softforce/vision/board.h"

namespace softforce::printing {

// Calibration board; AprilGrids with so many cells of black around their codes: 1 as AprilTag and
// OpenCV read them, 2 as Kalibr's own programs do. DetectBoard reads both.
struct BoardTarget {
  vision::Board board;
  int black_border = 1;
};

// Single AprilTags, to cut out: upright as vision::Tag means it, with their ids.
struct TagsTarget {
  std::string family = "tag36h11";
  double size = 30e-3;  // m, side of the square whose corners are detected
  int first = 0;
  int count = 0;  // 0: as many as fit
};

// Dots for the body, to cut out.
struct MarkersTarget {
  double diameter = 6e-3;  // m
  double rim = 2e-3;       // m, from the dot to the cut on each side
  int count = 0;           // 0: as many as fit
  bool white = false;      // white dots on black instead of black dots on white
};

using Target = std::variant<BoardTarget, TagsTarget, MarkersTarget>;

// How targets are written, a line each.
extern const char* const kTargetHelp;

// Reads "tags:size=30mm,count=4", "markers", "charuco" (the kind's default), or a board as
// vision::ParseBoard does, where an aprilgrid may also have border=2. Throws InputError, naming
// `where`, with the fix.
Target ParseTarget(const std::string& text, const std::string& where = "target");

// As ParseTarget reads it.
std::string TextOf(const Target& target);

// The target in true size with a ruler and a line that says what it is. Throws InputError if it
// does not fit on the paper, naming the largest of its kind that does.
Sheet DrawTarget(const Target& target, const SheetOptions& options = {});

}  // namespace softforce::printing
