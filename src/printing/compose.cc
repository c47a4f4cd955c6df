#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printing/pattern.h"
#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"

namespace softforce::printing {
namespace {

constexpr double kMm = 1e-3;
constexpr double kStrip = 15 * kMm;  // for two lines of text and the ruler, at the bottom

struct Size {
  const char* name;
  double short_side, long_side;  // m
};

constexpr Size kSizes[] = {{"A4", 210 * kMm, 297 * kMm},
                           {"A3", 297 * kMm, 420 * kMm},
                           {"Letter", 215.9 * kMm, 279.4 * kMm}};

const Size& SizeOf(const std::string& name) {
  for (const Size& size : kSizes) {
    if (base::LowerCase(name) == base::LowerCase(size.name)) return size;
  }
  throw base::InputError("--paper",
                         fmt::format("\"{}\" is not known; expected A4, A3 or Letter", name));
}

// A ruler from `from` on: ticks every millimetre, longer ones every five and ten, a number every
// ten. Its line is exactly as long as the last number says.
void AddRuler(const Eigen::Vector2d& from, bool vertical, int length_mm, Sheet* sheet) {
  constexpr double kLine = 0.1 * kMm, kFont = 2.1 * kMm;
  const Eigen::Vector2d along = vertical ? Eigen::Vector2d(0, -kMm) : Eigen::Vector2d(kMm, 0);
  const Eigen::Vector2d across = vertical ? Eigen::Vector2d(kMm, 0) : Eigen::Vector2d(0, kMm);
  sheet->lines.push_back({from, from + length_mm * along, kLine});
  for (int mm = 0; mm <= length_mm; ++mm) {
    const double tick = mm % 10 == 0 ? 3 : mm % 5 == 0 ? 2.2 : 1.4;
    const Eigen::Vector2d at = from + mm * along;
    sheet->lines.push_back({at, at + tick * across, kLine});
    if (mm % 10 != 0) continue;
    Sheet::Text label;
    label.text = fmt::format(mm == length_mm ? "{} mm" : "{}", mm);
    label.at =
        at + (vertical ? Eigen::Vector2d(3.5 * kMm, 0.7 * kMm) : Eigen::Vector2d(0, 5.2 * kMm));
    label.size = kFont;
    label.max_width = 12 * kMm;
    label.anchor = vertical ? Sheet::Text::Anchor::kLeft : Sheet::Text::Anchor::kMiddle;
    sheet->texts.push_back(std::move(label));
  }
}

// Whole centimetres that fit, at most `most` mm.
int RulerLength(double room, int most) {
  return std::clamp(static_cast<int>(std::floor(room / (10 * kMm))) * 10, 0, most);
}

}  // namespace

void SheetOptions::Check() const {
  SizeOf(paper);
  if (margin >= 0 && margin <= 30 * kMm) return;
  throw base::InputError("--margin",
                         fmt::format("got {:g} mm, must lie between 0 and 30 mm", margin / kMm));
}

Orientation ParseOrientation(const std::string& text, const std::string& where) {
  if (text == "best") return Orientation::kBest;
  if (text == "portrait") return Orientation::kPortrait;
  if (text == "landscape") return Orientation::kLandscape;
  throw base::InputError(
      where, fmt::format("\"{}\" is not known; expected best, portrait or landscape", text));
}

std::vector<Paper> AllowedPapers(const SheetOptions& options) {
  const Size& size = SizeOf(options.paper);
  std::vector<Paper> papers;
  if (options.orientation != Orientation::kLandscape) {
    papers.push_back({std::string(size.name) + " portrait", size.short_side, size.long_side});
  }
  if (options.orientation != Orientation::kPortrait) {
    papers.push_back({std::string(size.name) + " landscape", size.long_side, size.short_side});
  }
  return papers;
}

Eigen::Vector2d Room(const Paper& paper, const SheetOptions& options, double quiet) {
  // Paper is white: the margin counts as quiet too, the strip with its ink does not.
  const double edge = std::max(options.margin, quiet);
  return {paper.width - 2 * edge, paper.height - edge - options.margin - kStrip - quiet};
}

Sheet Compose(const Pattern& pattern, const Paper& paper, const SheetOptions& options,
              const std::string& title, const std::string& usage) {
  Sheet sheet = pattern.ink;
  sheet.width = paper.width;
  sheet.height = paper.height;
  sheet.title = title;
  const Eigen::Vector2d room = Room(paper, options, pattern.quiet);
  const double edge = std::max(options.margin, pattern.quiet);
  const Eigen::Vector2d shift(0.5 * (paper.width - pattern.width),
                              edge + 0.5 * (room.y() - pattern.height));
  for (Eigen::AlignedBox2d& box : sheet.black) box.translate(shift);
  for (Sheet::Disc& disc : sheet.discs) disc.centre += shift;
  for (Sheet::Line& line : sheet.lines) {
    line.from += shift;
    line.to += shift;
  }
  for (Sheet::Text& text : sheet.texts) text.at += shift;

  const double left = std::max(options.margin, 5 * kMm) + 3 * kMm;
  const double strip = paper.height - options.margin - kStrip, width = paper.width - 2 * left;
  sheet.texts.push_back({title, {left, strip + 3.2 * kMm}, 2.8 * kMm, width});
  sheet.texts.push_back({usage, {left, strip + 7 * kMm}, 2.8 * kMm, width});
  AddRuler({left, strip + 8.6 * kMm}, false, RulerLength(width, 150), &sheet);
  // One across the other direction as well, where there is room beside the pattern.
  const double beside = shift.x() - pattern.quiet - options.margin;
  if (beside > 13 * kMm) {
    const int length = RulerLength(strip - options.margin - 10 * kMm, 150);
    AddRuler({options.margin + 1 * kMm, strip - 4 * kMm}, true, length, &sheet);
  }
  return sheet;
}

}  // namespace softforce::printing
