#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace softforce::render {

// What a square pixel behind a slightly blurred lens makes of a picture with several rays per
// pixel.
class LensBlur {
 public:
  // `blur`: px, standard deviation; `rays`: per pixel in each direction.
  LensBlur(double blur, int rays);

  int margin() const { return margin_; }  // px around a part of the picture that it looks at

  // From the rays of an area to the grey levels of its pixels, without the margin.
  cv::Mat1f Apply(const cv::Mat1f& along_rays) const;

 private:
  int rays_, margin_;
  std::vector<float> weights_;  // of the rays of 2 · margin + 1 pixels, sum 1
};

}  // namespace softforce::render
