#include "softforce/render/side_by_side.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "render/labels.h"

namespace softforce::render {
namespace {

int Even(double length) { return std::max(2, 2 * static_cast<int>(std::floor(length / 2))); }

// In halves as far as these go, each pixel the mean of four, and between pixels for the rest: a
// tenth of the time of means over parts of pixels.
cv::Mat InSize(cv::Mat picture, const cv::Size& size) {
  while (picture.cols >= 2 * size.width && picture.rows >= 2 * size.height) {
    cv::Mat half;
    cv::resize(picture, half, picture.size() / 2, 0, 0, cv::INTER_AREA);
    picture = half;
  }
  if (picture.size() == size) return picture;
  cv::Mat scaled;
  cv::resize(picture, scaled, size, 0, 0, cv::INTER_LINEAR);
  return scaled;
}

}  // namespace

PictureRow SideBySide(const std::vector<cv::Size>& pictures, int max_width) {
  int width = 0;
  for (const cv::Size& picture : pictures) width += picture.width;
  const double scale = width > max_width ? static_cast<double>(max_width) / width : 1;
  PictureRow row;
  for (const cv::Size& picture : pictures) {
    const cv::Size size(Even(scale * picture.width), Even(scale * picture.height));
    row.cells.emplace_back(cv::Point(row.size.width, 0), size);
    row.size.width += size.width;
    row.size.height = std::max(row.size.height, size.height);
  }
  return row;
}

void PutPicture(const cv::Mat& picture, cv::Mat3b cell) {
  const cv::Mat scaled = InSize(picture, cell.size());
  if (scaled.channels() == 1) {
    cv::cvtColor(scaled, cell, cv::COLOR_GRAY2BGR);
  } else {
    scaled.copyTo(cell);
  }
}

camera::Camera Scaled(const camera::Camera& camera, const cv::Size& from, const cv::Size& to) {
  if (from == to) return camera;
  camera::Camera scaled = camera;
  const double x = static_cast<double>(to.width) / from.width;
  const double y = static_cast<double>(to.height) / from.height;
  scaled.width = to.width;
  scaled.height = to.height;
  // Corners of pixels stay corners: they lie half a pixel beside the centres that are counted.
  scaled.lens.cx = x * (camera.lens.cx + 0.5) - 0.5;
  scaled.lens.cy = y * (camera.lens.cy + 0.5) - 0.5;
  scaled.lens.fx *= x;
  scaled.lens.fy *= y;
  return scaled;
}

void DrawName(cv::Mat3b cell, const std::string& name, Easel* easel) {
  const double unit = std::max(0.75, cell.rows / 1024.0);
  const TextStyle style{0.6 * unit, std::max(1.0, unit)};
  const int margin = static_cast<int>(12 * unit);
  const int height = TextBlockBox({name}, {}, style).height;
  Brush brush(cell, easel);
  DrawTextBlock(&brush, {name}, {margin, cell.rows - margin - height}, style);
}

}  // namespace softforce::render
