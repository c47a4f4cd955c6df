#pragma once

#include <string>

#include "report/svg.h"

namespace softforce::report {

// A drawing with axes from 0 to round numbers.
class Chart {
 public:
  // What both axes show, and the largest values that must have room.
  Chart(double width, double height, const std::string& label, const std::string& y_label,
        double y_max);

  void XAxis(const std::string& label, double x_max);  // with ticks at round numbers
  void XLabel(const std::string& label);

  double X(double value) const { return kLeft + value / x_max_ * (width_ - kLeft - kRight); }
  double Y(double value) const { return height_ - kBottom - value / y_max_ * plot_height(); }
  double y_max() const { return y_max_; }
  double plot_height() const { return height_ - kTop - kBottom; }
  double left() const { return kLeft; }
  double plot_width() const { return width_ - kLeft - kRight; }
  double bottom() const { return height_ - kBottom; }

  Svg svg;

 private:
  static constexpr double kLeft = 46, kRight = 12, kTop = 20, kBottom = 36;
  double width_, height_, y_max_, x_max_ = 1;
};

}  // namespace softforce::report
