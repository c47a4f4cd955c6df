#include "render/lens_blur.h"

#include <cmath>
#include <numeric>

namespace softforce::render {
namespace {

// The share of a pixel's width that a lens with this blur lets see a place at `x` px from its
// centre.
double Weight(double x, double blur) {
  if (blur <= 0) return std::abs(x) < 0.5 ? 1 : 0;
  const double scale = blur * M_SQRT2;
  return 0.5 * (std::erf((x + 0.5) / scale) - std::erf((x - 0.5) / scale));
}

}  // namespace

LensBlur::LensBlur(double blur, int rays)
    : rays_(rays), margin_(static_cast<int>(std::ceil(3.5 * blur))) {
  for (int i = 0; i < (2 * margin_ + 1) * rays; ++i) {
    const double x = (i + 0.5) / rays - 0.5 - margin_;
    weights_.push_back(static_cast<float>(Weight(x, blur)));
  }
  const float sum = std::accumulate(weights_.begin(), weights_.end(), 0.0f);
  for (float& weight : weights_) weight /= sum;
}

cv::Mat1f LensBlur::Apply(const cv::Mat1f& along_rays) const {
  const int taps = static_cast<int>(weights_.size());
  const int width = along_rays.cols / rays_ - 2 * margin_;
  const int height = along_rays.rows / rays_ - 2 * margin_;
  cv::Mat1f rows(along_rays.rows, width);
  for (int y = 0; y < along_rays.rows; ++y) {
    for (int x = 0; x < width; ++x) {
      const float* from = along_rays[y] + x * rays_;
      float sum = 0;
      for (int k = 0; k < taps; ++k) sum += weights_[k] * from[k];
      rows(y, x) = sum;
    }
  }
  cv::Mat1f pixels(height, width, 0.0f);
  for (int y = 0; y < height; ++y) {
    float* out = pixels[y];
    for (int k = 0; k < taps; ++k) {
      const float* from = rows[y * rays_ + k];
      for (int x = 0; x < width; ++x) out[x] += weights_[k] * from[x];
    }
  }
  return pixels;
}

}  // namespace softforce::render
