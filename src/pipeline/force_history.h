#pragma once

#include <cmath>
#include <vector>

#include "softforce/pipeline/frame_result.h"
#include "softforce/render/force_chart.h"

namespace softforce::pipeline {

// The forces of the last seconds, for the strip below the pictures.
class ForceHistory {
 public:
  // The frames in their order.
  void Add(const FrameResult& result);

  // Fills the strip with the forces up to the newest frame.
  void Draw(const cv::Mat3b& strip, render::Easel* easel) const;

  // px, even, of the strip below pictures of this height.
  static int StripHeight(int pictures_height);

 private:
  std::vector<render::ChartSeries> series_;
  double first_s_ = NAN, newest_s_ = NAN;
};

}  // namespace softforce::pipeline
