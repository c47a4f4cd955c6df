#include <algorithm>
#include <cassert>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "render/labels.h"
#include "softforce/render/overlay.h"

namespace softforce::render {
namespace {

int Even(double length) { return std::max(2, 2 * static_cast<int>(std::floor(length / 2))); }

void DrawName(const cv::Mat3b& picture, const std::string& name) {
  const double unit = std::max(0.6, picture.rows / 1024.0);
  const TextStyle style{0.6 * unit, 1};
  const int margin = static_cast<int>(12 * unit);
  const int height = TextBlockBox({name}, {}, style).height;
  Brush brush(picture);
  DrawTextBlock(&brush, {name}, {margin, picture.rows - margin - height}, style);
}

}  // namespace

cv::Mat SideBySide(const std::vector<cv::Mat>& pictures, const std::vector<std::string>& names,
                   int max_width) {
  assert(pictures.size() == names.size());
  int width = 0;
  for (const cv::Mat& picture : pictures) width += picture.cols;
  const double scale = width > max_width ? static_cast<double>(max_width) / width : 1;

  std::vector<cv::Size> sizes;
  cv::Size total;
  for (const cv::Mat& picture : pictures) {
    sizes.emplace_back(Even(scale * picture.cols), Even(scale * picture.rows));
    total.width += sizes.back().width;
    total.height = std::max(total.height, sizes.back().height);
  }
  cv::Mat3b row(total, kBlack);
  int left = 0;
  for (size_t i = 0; i < pictures.size(); ++i) {
    cv::Mat3b cell = row(cv::Rect({left, 0}, sizes[i]));
    cv::Mat scaled;
    cv::resize(pictures[i], scaled, sizes[i], 0, 0, cv::INTER_AREA);
    if (scaled.channels() == 1) {
      cv::cvtColor(scaled, cell, cv::COLOR_GRAY2BGR);
    } else {
      scaled.copyTo(cell);
    }
    DrawName(cell, names[i]);
    left += sizes[i].width;
  }
  return row;
}

}  // namespace softforce::render
