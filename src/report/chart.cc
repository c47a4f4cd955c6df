#include "report/chart.h"

#include <fmt/format.h>

#include <cmath>

namespace softforce::report {
namespace {

std::string Tick(double value) { return fmt::format("{:.10g}", value); }

}  // namespace

Chart::Chart(double width, double height, const std::string& label, const std::string& y_label,
             double y_max)
    : svg(width, height, label), width_(width), height_(height) {
  const double step = RoundStep(y_max, 4);
  const int steps = std::max(1, static_cast<int>(std::ceil(y_max / step - 1e-9)));
  y_max_ = steps * step;
  for (int i = 0; i <= steps; ++i) {
    svg.Line(kLeft, Y(i * step), width_ - kRight, Y(i * step), i == 0 ? "axis" : "grid");
    svg.Text(kLeft - 6, Y(i * step) + 4, Tick(i * step), "end");
  }
  svg.Text(4, 12, y_label);
}

void Chart::XAxis(const std::string& label, double x_max) {
  const double step = RoundStep(x_max, 8);
  const int steps = std::max(1, static_cast<int>(std::ceil(x_max / step - 1e-9)));
  x_max_ = steps * step;
  for (int i = 0; i <= steps; ++i) {
    svg.Line(X(i * step), bottom(), X(i * step), bottom() + 4, "axis");
    svg.Text(X(i * step), bottom() + 16, Tick(i * step), "middle");
  }
  XLabel(label);
}

void Chart::XLabel(const std::string& label) {
  svg.Text(kLeft + plot_width() / 2, height_ - 4, label, "middle");
}

}  // namespace softforce::report
