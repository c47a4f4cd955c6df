#pragma once

#include <string>

#include "report/svg.h"

namespace softforce::report {

// A drawing with axes whose ends are round numbers.
class Chart {
 public:
  // What both axes show, and the values that must have room: from 0, or what is less, to y_max.
  Chart(double width, double height, const std::string& label, const std::string& y_label,
        double y_max, double y_min = 0);

  // One without a y axis, for rows.
  Chart(double width, double height, const std::string& label);

  void XAxis(const std::string& label, double x_max);  // from 0, with ticks at round numbers
  // Ends where the data end, with ticks at round numbers between.
  void XAxis(const std::string& label, double x_min, double x_max);
  void XLabel(const std::string& label);

  double X(double value) const {
    return kLeft + (value - x_min_) / (x_max_ - x_min_) * plot_width();
  }
  double Y(double value) const {
    return height_ - kBottom - (value - y_min_) / (y_max_ - y_min_) * plot_height();
  }
  double y_max() const { return y_max_; }
  double plot_height() const { return height_ - kTop - kBottom; }
  double left() const { return kLeft; }
  double plot_width() const { return width_ - kLeft - kRight; }
  double top() const { return kTop; }
  double bottom() const { return height_ - kBottom; }

  // The drawing in a box that tells the page's script where the plot is; `key` names its values in
  // the page's data.
  std::string Readable(const std::string& key) const;

  static constexpr double kTop = 20, kBottom = 36;  // px, room above and below the plot

  Svg svg;

 private:
  static constexpr double kLeft = 46, kRight = 12;
  void XTick(double value);

  double width_, height_, y_max_ = 1, y_min_ = 0, x_max_ = 1, x_min_ = 0;
};

}  // namespace softforce::report
