#include "render/depth_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace softforce::render {
namespace {

// Of its inverse depth: a point this much behind a surface still lies on it (1 mm at 0.5 m).
constexpr double kDepthTolerance = 2e-3;

// Where the triangle's outline crosses the row of pixels at height y.
std::pair<double, double> RowSpan(const std::array<cv::Point2d, 3>& corners, double y) {
  double left = std::numeric_limits<double>::infinity();
  double right = -left;
  for (int i = 0; i < 3; ++i) {
    const cv::Point2d& p = corners[i];
    const cv::Point2d& q = corners[(i + 1) % 3];
    if (y < std::min(p.y, q.y) || y > std::max(p.y, q.y)) continue;
    const double x = p.y == q.y ? p.x : p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
    left = std::min({left, x, p.y == q.y ? q.x : x});
    right = std::max({right, x, p.y == q.y ? q.x : x});
  }
  return {left, right};
}

}  // namespace

void DepthBuffer::AddTriangle(const Sight& a, const Sight& b, const Sight& c, int name) {
  const cv::Point2d ab = b.pixel - a.pixel;
  const cv::Point2d ac = c.pixel - a.pixel;
  const double area = ab.x * ac.y - ab.y * ac.x;  // px², twice the triangle's
  if (std::abs(area) < 1e-9) return;
  const double db = b.inverse_depth - a.inverse_depth;
  const double dc = c.inverse_depth - a.inverse_depth;
  const double per_x = (db * ac.y - dc * ab.y) / area;
  const double per_y = (dc * ab.x - db * ac.x) / area;

  const auto [low, high] = std::minmax({a.pixel.y, b.pixel.y, c.pixel.y});
  const int first_row = std::max(0, static_cast<int>(std::ceil(low)));
  const int last_row = std::min(inverse_depth_.rows - 1, static_cast<int>(std::floor(high)));
  for (int y = first_row; y <= last_row; ++y) {
    const auto [left, right] = RowSpan({a.pixel, b.pixel, c.pixel}, y);
    const int first = std::max(0, static_cast<int>(std::ceil(left)));
    const int last = std::min(inverse_depth_.cols - 1, static_cast<int>(std::floor(right)));
    float* row = inverse_depth_[y];
    int* names = nearest_[y];
    const auto step = static_cast<float>(per_x);
    const auto start =
        static_cast<float>(a.inverse_depth + per_x * (first - a.pixel.x) + per_y * (y - a.pixel.y));
    for (int x = first; x <= last; ++x) {
      const float here = start + step * static_cast<float>(x - first);
      if (here <= row[x]) continue;
      row[x] = here;
      names[x] = name;
    }
  }
}

bool DepthBuffer::Hides(const cv::Point2d& pixel, double inverse_depth) const {
  const int x = static_cast<int>(std::lround(pixel.x));
  const int y = static_cast<int>(std::lround(pixel.y));
  if (x < 1 || y < 1 || x + 1 >= inverse_depth_.cols || y + 1 >= inverse_depth_.rows) return false;
  // The farthest neighbour, so that a surface seen at a grazing angle does not hide its own edges.
  float farthest = std::numeric_limits<float>::infinity();
  for (int row = y - 1; row <= y + 1; ++row) {
    const float* depths = inverse_depth_[row] + x;
    farthest = std::min({farthest, depths[-1], depths[0], depths[1]});
  }
  return inverse_depth < farthest * (1 - kDepthTolerance);
}

}  // namespace softforce::render
