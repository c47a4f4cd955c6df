#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/render/easel.h"

namespace softforce::render {

// One force over time; `value` may hold NaN where it was not known.
struct ChartSeries {
  std::string label;
  std::vector<double> time_s;  // ascending
  std::vector<double> value;   // N
  std::vector<double> sd;      // N
};

// Fills a strip with forces over time, each a line in its 95 % band, with its label and last value
// at the right. Shows `span_s` seconds up to `now_s`; the force's axis begins at 0 and ends at the
// next round number.
void DrawForceChart(cv::Mat3b strip, const std::vector<ChartSeries>& series, double now_s,
                    double span_s, Easel* easel = nullptr);

// The next of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not below a number > 0.
double RoundUp(double number);

}  // namespace softforce::render
