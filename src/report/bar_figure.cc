#include "report/bar_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/format.h"
#include "report/page.h"
#include "report/svg.h"

namespace softforce::report {
namespace {

constexpr double kWidth = 940, kHeight = 240;
constexpr double kLeft = 56, kRight = 12, kTop = 20, kBottom = 30;  // px, room about the plot
constexpr double kSpot = 4;                                         // px, radius

// A value axis that goes up: linear from 0, or logarithmic over whole decades.
class Axis {
 public:
  explicit Axis(const BarFigure& figure) : logarithmic_(figure.logarithmic) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const BarSeries& series : figure.series) {
      for (const double value : series.values) {
        if (!Shows(value)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
    if (!(most > 0)) least = most = 1;
    if (logarithmic_) {
      low_ = std::floor(std::log10(least) - 1e-9);
      high_ = std::max(std::ceil(std::log10(most)), low_ + 1);
      step_ = std::ceil((high_ - low_) / 8);
    } else {
      step_ = RoundStep(most, 4);
      high_ = step_ * std::ceil(most / step_ - 1e-9);
    }
  }

  bool Shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0); }

  double Y(double value) const { return At(logarithmic_ ? std::log10(value) : value); }

  void Draw(const std::string& label, Svg* svg) const {
    for (int i = 0; low_ + i * step_ <= high_ + 1e-9 * step_; ++i) {
      const double at = low_ + i * step_;
      svg->Line(kLeft, At(at), kWidth - kRight, At(at), i == 0 ? "axis" : "grid");
      svg->Text(kLeft - 6, At(at) + 4,
                logarithmic_ ? fmt::format("{:g}", std::pow(10, at)) : fmt::format("{:.10g}", at),
                "end");
    }
    svg->Text(4, 12, label);
  }

 private:
  // px, of a place on the axis.
  double At(double place) const {
    return kHeight - kBottom - (place - low_) / (high_ - low_) * (kHeight - kTop - kBottom);
  }

  bool logarithmic_;
  double low_ = 0, high_ = 1, step_ = 1;  // of values, or of their decimal logarithms
};

std::string Tooltip(const BarFigure& figure, const BarSeries& series, size_t group) {
  return fmt::format("{}, {}: {}", figure.groups[group], series.name, Short(series.values[group]));
}

}  // namespace

std::string DrawBars(const BarFigure& figure) {
  Svg svg(kWidth, kHeight, figure.title);
  const Axis axis(figure);
  axis.Draw(figure.y_label, &svg);
  const auto bars = std::max<std::ptrdiff_t>(
      1, std::count_if(figure.series.begin(), figure.series.end(),
                       [](const BarSeries& series) { return !series.points; }));
  const double pitch =
      (kWidth - kLeft - kRight) / static_cast<double>(std::max<size_t>(figure.groups.size(), 1));
  const double group_width = std::min(0.8 * pitch, 34.0 * static_cast<double>(bars));
  const double bar_width = group_width / static_cast<double>(bars);
  for (size_t g = 0; g < figure.groups.size(); ++g) {
    const double middle = kLeft + (static_cast<double>(g) + 0.5) * pitch;
    svg.Text(middle, kHeight - kBottom + 16, figure.groups[g], "middle");
    double left = middle - 0.5 * group_width;
    for (size_t s = 0; s < figure.series.size(); ++s) {
      const BarSeries& series = figure.series[s];
      const double x = series.points ? middle : left;
      if (!series.points) left += bar_width;
      if (g >= series.values.size() || !axis.Shows(series.values[g])) continue;
      const double y = axis.Y(series.values[g]);
      const std::string hue = HueClass(static_cast<int>(s));
      if (series.points) {
        svg.Circle(x, y, kSpot, "spot " + hue, Tooltip(figure, series, g));
      } else {
        svg.Rect(x, y, 0.92 * bar_width, kHeight - kBottom - y, "bar " + hue,
                 Tooltip(figure, series, g));
      }
    }
  }
  std::string key;
  for (size_t s = 0; s < figure.series.size(); ++s) {
    key += Key(HueClass(static_cast<int>(s)),
               figure.series[s].name + (figure.series[s].points ? " (spots)" : ""));
  }
  return Figure(svg.str(), key + (figure.caption.empty() ? "" : ". " + figure.caption));
}

}  // namespace softforce::report
