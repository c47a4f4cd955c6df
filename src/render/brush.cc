#include "render/brush.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace softforce::render {
namespace {

constexpr int kFractionBits = 4;  // OpenCV draws with fixed-point coordinates

cv::Point Fixed(const cv::Point2d& p) {
  constexpr double kOne = 1 << kFractionBits;
  return {static_cast<int>(std::lround(p.x * kOne)), static_cast<int>(std::lround(p.y * kOne))};
}

int Thickness(double width) { return std::max(1, static_cast<int>(std::lround(width))); }

cv::Rect BoxAround(const cv::Point2d& a, const cv::Point2d& b, double margin) {
  const int left = static_cast<int>(std::floor(std::min(a.x, b.x) - margin));
  const int top = static_cast<int>(std::floor(std::min(a.y, b.y) - margin));
  const int right = static_cast<int>(std::ceil(std::max(a.x, b.x) + margin));
  const int bottom = static_cast<int>(std::ceil(std::max(a.y, b.y) + margin));
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace

Brush::Brush(cv::Mat3b picture)
    : picture_(std::move(picture)), mask_(cv::Mat1b::zeros(picture_.size())) {}

void Brush::Touch(const cv::Rect& box) { touched_ |= box & cv::Rect(cv::Point(), picture_.size()); }

void Brush::Line(const cv::Point2d& a, const cv::Point2d& b, double width) {
  cv::line(mask_, Fixed(a), Fixed(b), 255, Thickness(width), cv::LINE_AA, kFractionBits);
  Touch(BoxAround(a, b, width + 3));
}

void Brush::Polyline(const std::vector<cv::Point2d>& points, double width) {
  for (size_t i = 0; i + 1 < points.size(); ++i) Line(points[i], points[i + 1], width);
}

void Brush::Polygon(const std::vector<cv::Point2d>& corners) {
  std::vector<cv::Point> fixed;
  for (const cv::Point2d& corner : corners) {
    fixed.push_back(Fixed(corner));
    Touch(BoxAround(corners.front(), corner, 3));
  }
  cv::fillConvexPoly(mask_, fixed, 255, cv::LINE_AA, kFractionBits);
}

void Brush::Disc(const cv::Point2d& centre, double radius) {
  const int fixed_radius = static_cast<int>(std::lround(radius * (1 << kFractionBits)));
  cv::circle(mask_, Fixed(centre), fixed_radius, 255, cv::FILLED, cv::LINE_AA, kFractionBits);
  Touch(BoxAround(centre, centre, radius + 3));
}

void Brush::Arc(const cv::Point2d& centre, double radius, double from, double to, double width) {
  constexpr double kStep = 10;  // degrees
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / kStep)));
  std::vector<cv::Point2d> points;
  for (int i = 0; i <= pieces; ++i) {
    const double angle = (from + (to - from) * i / pieces) * CV_PI / 180;
    points.push_back(centre + radius * cv::Point2d(std::cos(angle), std::sin(angle)));
  }
  Polyline(points, width);
}

void Brush::Text(const std::string& text, const cv::Point& baseline_left, int font, double scale,
                 int width) {
  cv::putText(mask_, text, baseline_left, font, scale, 255, width, cv::LINE_AA);
  int below = 0;
  const cv::Size size = cv::getTextSize(text, font, scale, width, &below);
  const cv::Point2d corner(baseline_left.x, baseline_left.y - size.height);
  Touch(BoxAround(corner, corner + cv::Point2d(size.width, size.height + below), width + 3));
}

void Brush::Paint(const cv::Vec3b& colour, double opacity) {
  const int strength = static_cast<int>(std::lround(opacity * 256));
  for (int y = touched_.y; y < touched_.br().y; ++y) {
    uchar* coverage = mask_[y];
    cv::Vec3b* pixels = picture_[y];
    for (int x = touched_.x; x < touched_.br().x; ++x) {
      if (coverage[x] == 0) continue;
      const int share = coverage[x] * strength / 255;  // of 256
      for (int i = 0; i < 3; ++i) {
        pixels[x][i] = cv::saturate_cast<uchar>(
            (pixels[x][i] * (256 - share) + colour[i] * share + 128) / 256);
      }
      coverage[x] = 0;
    }
  }
  touched_ = {};
}

}  // namespace softforce::render
