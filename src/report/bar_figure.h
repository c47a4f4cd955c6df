#pragma once

#include <string>
#include <vector>

namespace softforce::report {

// Values of one kind, one for each group; NaN: none.
struct BarSeries {
  std::string name;
  std::vector<double> values;
  bool points = false;  // spots instead of bars, for what is given to compare with
};

// Groups of bars beside each other.
struct BarFigure {
  std::string title;    // what it shows, for those who cannot see it
  std::string y_label;  // "I_e, mN"
  bool logarithmic = false;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
  std::string caption;  // HTML, after the key of the series
};

// As HTML: an inline SVG with its key and caption. Values that a logarithmic axis has no place for,
// 0 and less, are left out.
std::string DrawBars(const BarFigure& figure);

}  // namespace softforce::report
