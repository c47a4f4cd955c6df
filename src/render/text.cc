#include "render/text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/palette.h"

namespace softforce::render {
namespace {

constexpr double kCapital = 21;   // px above the baseline at a scale of 1
constexpr double kCorner = 8;     // px, radius of a plate's corners
constexpr double kDescender = 7;  // px below it, of letters such as g
const std::string kPlusMinus = "±";

// The text cut at each ±, which stands as a piece of its own.
std::vector<std::string> Pieces(const std::string& text) {
  std::vector<std::string> pieces;
  size_t start = 0;
  while (start < text.size()) {
    const size_t sign = text.find(kPlusMinus, start);
    if (sign == start) {
      pieces.push_back(kPlusMinus);
      start += kPlusMinus.size();
    } else {
      pieces.push_back(text.substr(start, sign - start));
      start = sign == std::string::npos ? text.size() : sign;
    }
  }
  return pieces;
}

// px at a scale of 1.
double Advance(const std::string& piece) {
  return Alphabet::Advance(piece == kPlusMinus ? "+" : piece);
}

void DrawPlusMinus(Brush* brush, const cv::Point2d& baseline_left, const TextStyle& style,
                   double width) {
  const double arm = 0.28 * style.scale * Advance(kPlusMinus);
  const cv::Point2d foot = baseline_left + cv::Point2d(0.5 * style.scale * Advance(kPlusMinus), 0);
  const cv::Point2d cross = foot - cv::Point2d(0, kCapital * style.scale - arm);
  brush->Line(cross - cv::Point2d(arm, 0), cross + cv::Point2d(arm, 0), width);
  brush->Line(cross - cv::Point2d(0, arm), cross + cv::Point2d(0, arm), width);
  brush->Line(foot - cv::Point2d(arm, 0), foot + cv::Point2d(arm, 0), width);
}

void Letters(Brush* brush, const std::string& text, cv::Point2d pen, const TextStyle& style,
             double width) {
  for (const std::string& piece : Pieces(text)) {
    if (piece == kPlusMinus) {
      DrawPlusMinus(brush, pen, style, width);
      pen.x += style.scale * Advance(piece);
    } else {
      pen = brush->Text(piece, pen, style.scale, width);
    }
  }
}

}  // namespace

TextExtent MeasureText(const std::string& text, const TextStyle& style) {
  double length = 0;  // px at a scale of 1
  bool below = false;
  for (const std::string& piece : Pieces(text)) {
    length += Advance(piece);
    below |= piece.find_first_of("gjpqy,;()[]_") != std::string::npos;
  }
  const auto whole = [](double px) { return static_cast<int>(std::ceil(px)); };
  return {whole(length * style.scale + style.width),
          whole(kCapital * style.scale + style.width / 2),
          below ? whole(kDescender * style.scale + style.width / 2) : 0};
}

void DrawText(Brush* brush, const std::string& text, const cv::Point& baseline_left,
              const TextStyle& style, const cv::Vec3b& colour) {
  Letters(brush, text, baseline_left, style, style.width + 2);
  brush->Paint(kBlack, 0.7);
  Letters(brush, text, baseline_left, style, style.width);
  brush->Paint(colour, 1);
}

void DrawPlate(Brush* brush, const cv::Rect& box) {
  const double radius = std::min({kCorner, 0.2 * box.width, 0.2 * box.height});
  const cv::Point2d inner_a(box.x + radius, box.y + radius);
  const cv::Point2d inner_b(box.br().x - radius, box.br().y - radius);
  std::vector<cv::Point2d> outline;
  for (int angle = 0; angle < 360; angle += 15) {
    const double a = (angle + 7.5) * CV_PI / 180;
    const cv::Point2d centre(std::cos(a) > 0 ? inner_b.x : inner_a.x,
                             std::sin(a) > 0 ? inner_b.y : inner_a.y);
    outline.push_back(centre + radius * cv::Point2d(std::cos(a), std::sin(a)));
  }
  brush->Polygon(outline);
  brush->Paint(kBlack, 0.55);
}

}  // namespace softforce::render
