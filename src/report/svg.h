#pragma once

#include <string>
#include <vector>

namespace softforce::report {

// A drawing for an HTML page, in units of about a pixel, y downwards. Looks come from the classes
// of the page's style sheet, or from `fill` where it carries a value.
class Svg {
 public:
  // `label`: what it shows, for those who cannot see it.
  Svg(double width, double height, const std::string& label);

  // `tooltip` may be empty, here as below.
  void Rect(double x, double y, double width, double height, const std::string& css_class,
            const std::string& tooltip = "", const std::string& fill = "");
  void Line(double x1, double y1, double x2, double y2, const std::string& css_class);
  void Circle(double x, double y, double radius, const std::string& css_class,
              const std::string& tooltip = "");
  // `anchor`: start, middle or end.
  void Text(double x, double y, const std::string& text, const std::string& anchor = "start",
            const std::string& css_class = "");
  void Path(const std::string& d, const std::string& css_class, const std::string& tooltip = "");

  std::string str() const;

 private:
  std::string text_;
};

// The strokes of a Path: many lines in one element.
std::string Stroke(double x1, double y1, double x2, double y2);

// A step of 1, 2 or 5 times a power of ten, so that about `steps` of them make up `range`.
double RoundStep(double range, int steps);

// A colour from dark blue over green to yellow (viridis) for 0 … 1, "#rrggbb".
std::string HeatColour(double share);

// The class of the nth colour, as of a camera or a force: "c0" … "c5", then again.
std::string HueClass(int n);

}  // namespace softforce::report
