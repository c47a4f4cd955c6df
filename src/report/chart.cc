#include "report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/format.h"

namespace softforce::report {
namespace {

std::string Tick(double value) { return fmt::format("{:.10g}", value); }

}  // namespace

Chart::Chart(double width, double height, const std::string& label, const std::string& y_label,
             double y_max, double y_min)
    : svg(width, height, label), width_(width), height_(height) {
  const double step = RoundStep(y_max - std::min(y_min, 0.0), 4);
  const int above = std::max(1, static_cast<int>(std::ceil(y_max / step - 1e-9)));
  const int below = std::min(0, static_cast<int>(std::floor(y_min / step + 1e-9)));
  y_max_ = above * step;
  y_min_ = below * step;
  for (int i = below; i <= above; ++i) {
    svg.Line(kLeft, Y(i * step), width_ - kRight, Y(i * step), i == 0 ? "axis" : "grid");
    svg.Text(kLeft - 6, Y(i * step) + 4, Tick(i * step), "end");
  }
  svg.Text(4, 12, y_label);
}

Chart::Chart(double width, double height, const std::string& label)
    : svg(width, height, label), width_(width), height_(height) {}

void Chart::XTick(double value) {
  svg.Line(X(value), bottom(), X(value), bottom() + 4, "axis");
  svg.Text(X(value), bottom() + 16, Tick(value), "middle");
}

void Chart::XAxis(const std::string& label, double x_max) {
  const double step = RoundStep(x_max, 8);
  const int steps = std::max(1, static_cast<int>(std::ceil(x_max / step - 1e-9)));
  x_max_ = steps * step;
  for (int i = 0; i <= steps; ++i) XTick(i * step);
  XLabel(label);
}

void Chart::XAxis(const std::string& label, double x_min, double x_max) {
  x_min_ = x_min;
  x_max_ = x_max > x_min ? x_max : x_min + 1;
  const double step = RoundStep(x_max_ - x_min_, 8);
  const double first = std::ceil(x_min_ / step - 1e-9);
  for (int i = 0; (first + i) * step <= x_max_ + 1e-9 * step; ++i) XTick((first + i) * step);
  XLabel(label);
}

void Chart::XLabel(const std::string& label) {
  svg.Text(kLeft + plot_width() / 2, height_ - 4, label, "middle");
}

std::string Chart::Readable(const std::string& key) const {
  return fmt::format(
      "<div class=\"hover\" data-chart=\"{}\" data-left=\"{:g}\" data-width=\"{:g}\" "
      "data-top=\"{:g}\" data-bottom=\"{:g}\">{}</div>",
      Escape(key), left(), plot_width(), top(), bottom(), svg.str());
}

}  // namespace softforce::report
