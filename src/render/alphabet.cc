#include "render/alphabet.h"

#include <algorithm>
#include <cmath>

namespace softforce::render {
namespace {

constexpr int kFiner = 4;               // letters are drawn so many times as large
constexpr double kAbove = 23;           // of the tallest letter, px at a scale of 1
constexpr double kBelow = 9;            // likewise
constexpr double kMeasuringScale = 64;  // at which OpenCV's whole pixels are fine enough

int RoundUp(double length) { return static_cast<int>(std::ceil(length)); }

Letter DrawLetter(char letter, double scale, double width, int quarter) {
  const int margin = RoundUp(width) + 1;  // px, on all sides
  const int above = RoundUp(kAbove * scale) + margin, below = RoundUp(kBelow * scale) + margin;
  const std::string text(1, letter);
  const cv::Size size(RoundUp(Alphabet::Advance(text) * scale) + 2 * margin + 1, above + below);
  cv::Mat1b large(size * kFiner, 0);
  const cv::Point pen(kFiner * margin + kFiner / 2 + quarter, kFiner * above + kFiner / 2);
  cv::putText(large, text, pen, Alphabet::kFont, kFiner * scale, 255,
              std::max(1, static_cast<int>(std::lround(kFiner * width))), cv::LINE_AA);
  Letter drawn{{}, {-margin, -above}};
  cv::resize(large, drawn.coverage, size, 0, 0, cv::INTER_AREA);
  return drawn;
}

}  // namespace

const Letter& Alphabet::Draw(char letter, double scale, double width, double x) {
  const int quarter = static_cast<int>(std::floor(kFiner * (x - std::floor(x))));
  Letter& drawn = letters_[{letter, scale, width, quarter}];
  if (drawn.coverage.empty()) drawn = DrawLetter(letter, scale, width, quarter);
  return drawn;
}

double Alphabet::Advance(const std::string& text) {
  int below = 0;
  const int thickness = 1;  // that OpenCV adds
  return (cv::getTextSize(text, kFont, kMeasuringScale, thickness, &below).width - thickness) /
         kMeasuringScale;
}

}  // namespace softforce::render
