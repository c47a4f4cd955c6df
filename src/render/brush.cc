#include "render/brush.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "render/easel_state.h"

namespace softforce::render {
namespace {

constexpr int kFractionBits = 4;  // OpenCV draws with fixed-point coordinates

cv::Point Fixed(const cv::Point2d& p) {
  constexpr double kOne = 1 << kFractionBits;
  return {cvRound(p.x * kOne), cvRound(p.y * kOne)};
}

int Thickness(double width) { return std::max(1, cvRound(width)); }

cv::Rect BoxAround(const cv::Point2d& a, const cv::Point2d& b, double margin) {
  const int left = static_cast<int>(std::floor(std::min(a.x, b.x) - margin));
  const int top = static_cast<int>(std::floor(std::min(a.y, b.y) - margin));
  const int right = static_cast<int>(std::ceil(std::max(a.x, b.x) + margin));
  const int bottom = static_cast<int>(std::ceil(std::max(a.y, b.y) + margin));
  return {left, top, right - left + 1, bottom - top + 1};
}

cv::Mat1b CleanMask(const cv::Size& size, Easel* easel) {
  cv::Mat1b& mask = easel->state().mask;
  if (mask.rows < size.height || mask.cols < size.width) {
    mask = cv::Mat1b::zeros(std::max(mask.rows, size.height), std::max(mask.cols, size.width));
  }
  return mask(cv::Rect({}, size));
}

// How many of the next pixels nothing was drawn on; most of a mask is of this kind.
int Untouched(const uchar* coverage, int count) {
  int i = 0;
  for (uint64_t eight = 0; i + 8 <= count; i += 8) {
    std::memcpy(&eight, coverage + i, 8);
    if (eight != 0) break;
  }
  while (i < count && coverage[i] == 0) ++i;
  return i;
}

}  // namespace

Brush::Brush(cv::Mat3b picture, Easel* easel)
    : picture_(std::move(picture)),
      alphabet_(&easel->state().alphabet),
      mask_(CleanMask(picture_.size(), easel)) {}

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
  const double reach = radius + width / 2 + 1;
  const cv::Rect box = BoxAround(centre, centre, reach) & cv::Rect({}, picture_.size());
  const auto within = [&](double dx, double dy) {
    if (to - from >= 360) return true;
    const double beyond = std::fmod(std::atan2(dy, dx) * 180 / CV_PI - from + 720, 360);
    return beyond <= to - from;
  };
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const double dx = x - centre.x, dy = y - centre.y;
      const double covered = width / 2 + 0.5 - std::abs(std::sqrt(dx * dx + dy * dy) - radius);
      if (covered <= 0 || !within(dx, dy)) continue;
      uchar& coverage = mask_(y, x);
      coverage = std::max(coverage, static_cast<uchar>(255 * std::min(covered, 1.0)));
    }
  }
  Touch(box);
}

cv::Point2d Brush::Text(const std::string& text, const cv::Point2d& baseline_left, double scale,
                        double width) {
  cv::Point2d pen = baseline_left;
  for (const char character : text) {
    const Letter& letter = alphabet_->Draw(character, scale, width, pen.x);
    const cv::Point corner = cv::Point(cvFloor(pen.x), cvRound(pen.y)) + letter.corner;
    const cv::Rect whole(corner, letter.coverage.size());
    const cv::Rect box = whole & cv::Rect({}, picture_.size());
    if (!box.empty()) {
      cv::Mat target = mask_(box);
      cv::max(target, letter.coverage(box - corner), target);
      Touch(box);
    }
    pen.x += scale * Alphabet::Advance(std::string(1, character));
  }
  return pen;
}

void Brush::Paint(const cv::Vec3b& colour, double opacity) {
  const auto strength = static_cast<unsigned>(cvRound(opacity * 256));
  for (int y = touched_.y; y < touched_.br().y; ++y) {
    uchar* coverage = mask_[y];
    cv::Vec3b* pixels = picture_[y];
    const int end = touched_.br().x;
    for (int x = touched_.x; x < end; ++x) {
      x += Untouched(coverage + x, end - x);
      if (x == end) break;
      const unsigned share = coverage[x] * strength / 255;  // of 256
      for (int i = 0; i < 3; ++i) {
        pixels[x][i] =
            static_cast<uchar>((pixels[x][i] * (256 - share) + colour[i] * share + 128) / 256);
      }
      coverage[x] = 0;
    }
  }
  touched_ = {};
}

}  // namespace softforce::render
