#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace softforce::printing {

enum class Orientation { kBest, kPortrait, kLandscape };

struct SheetOptions {
  std::string paper = "A4";                      // A4, A3 or Letter
  Orientation orientation = Orientation::kBest;  // kBest: whichever the pattern fits on
  double margin = 5e-3;                          // m, that printers leave white along each edge

  void Check() const;  // throws InputError naming the option
};

// "best", "portrait" or "landscape"; throws InputError, naming `where`, for anything else.
Orientation ParseOrientation(const std::string& text, const std::string& where = "--orientation");

// What is drawn on one sheet of paper, in metres from its top left corner, x right, y down.
struct Sheet {
  struct Disc {
    Eigen::Vector2d centre;
    double diameter;
    bool white = false;
  };
  struct Line {
    Eigen::Vector2d from, to;
    double width;
    bool light = false;  // light grey, to cut along
  };
  struct Text {
    enum class Anchor { kLeft, kMiddle };

    std::string text;
    Eigen::Vector2d at;  // the left end or the middle of its baseline
    double size;         // of the font
    double max_width;    // a longer text is set in a smaller size
    Anchor anchor = Anchor::kLeft;
  };

  double width = 0, height = 0;
  std::string title;
  std::vector<Eigen::AlignedBox2d> black;  // rectangles; painted as one shape, so without seams
  std::vector<Disc> discs;                 // over the rectangles
  std::vector<Line> lines;
  std::vector<Text> texts;
};

// Writes a .pdf or .svg of true size; the same sheet gives the same bytes. Throws InputError if the
// ending is another or the file cannot be written.
void WriteSheet(const std::filesystem::path& file, const Sheet& sheet);

}  // namespace softforce::printing
