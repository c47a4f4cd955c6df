#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/format.h"

namespace softforce::report {
namespace {

std::string Closed(const std::string& element, const std::string& tooltip) {
  if (tooltip.empty()) return fmt::format("<{}/>\n", element);
  return fmt::format("<{}><title>{}</title></{}>\n", element, Escape(tooltip),
                     element.substr(0, element.find(' ')));
}

}  // namespace

Svg::Svg(double width, double height, const std::string& label)
    : text_(fmt::format("<svg viewBox=\"0 0 {:g} {:g}\" style=\"max-width:{:g}px\" role=\"img\" "
                        "aria-label=\"{}\">\n",
                        width, height, width, Escape(label))) {}

void Svg::Rect(double x, double y, double width, double height, const std::string& css_class,
               const std::string& tooltip, const std::string& fill) {
  text_ += Closed(
      fmt::format("rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                  "height=\"{:.1f}\"{}",
                  css_class, x, y, width, height, fill.empty() ? "" : " fill=\"" + fill + "\""),
      tooltip);
}

void Svg::Line(double x1, double y1, double x2, double y2, const std::string& css_class) {
  text_ +=
      fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                  css_class, x1, y1, x2, y2);
}

void Svg::Circle(double x, double y, double radius, const std::string& css_class,
                 const std::string& tooltip) {
  text_ += Closed(fmt::format("circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\"",
                              css_class, x, y, radius),
                  tooltip);
}

void Svg::Text(double x, double y, const std::string& text, const std::string& anchor,
               const std::string& css_class) {
  text_ +=
      fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                  css_class, x, y, anchor, Escape(text));
}

void Svg::Path(const std::string& d, const std::string& css_class, const std::string& tooltip) {
  text_ += Closed(fmt::format("path class=\"{}\" d=\"{}\"", css_class, d), tooltip);
}

std::string Svg::str() const { return text_ + "</svg>\n"; }

std::string Stroke(double x1, double y1, double x2, double y2) {
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x1, y1, x2, y2);
}

double RoundStep(double range, int steps) {
  if (!(range > 0)) return 1;
  const double raw = range / steps;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (raw <= digit * power * (1 + 1e-9)) return digit * power;
  }
  return 10 * power;
}

std::string HeatColour(double share) {
  // viridis at 0, 1/6 … 1
  static constexpr std::array<std::array<double, 3>, 7> kStops = {{{68, 1, 84},
                                                                   {68, 57, 131},
                                                                   {49, 104, 142},
                                                                   {33, 145, 140},
                                                                   {53, 183, 121},
                                                                   {144, 215, 67},
                                                                   {253, 231, 37}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const size_t stop = std::min(static_cast<size_t>(place), kStops.size() - 2);
  const double rest = place - static_cast<double>(stop);
  std::array<int, 3> colour{};
  for (size_t i = 0; i < 3; ++i) {
    colour[i] =
        static_cast<int>(std::lround((1 - rest) * kStops[stop][i] + rest * kStops[stop + 1][i]));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::string HueClass(int n) { return fmt::format("c{}", n % 6); }

}  // namespace softforce::report
