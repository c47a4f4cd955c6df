#include "render/depth_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/plane.h"

namespace softforce::render {
namespace {

// Of its inverse depth: a point this much behind a surface still lies on it (1 mm at 0.5 m).
constexpr double kDepthTolerance = 2e-3;

// One side of a triangle, as x over y.
struct Side {
  double x, y, per_row;

  Side(const cv::Point2d& upper, const cv::Point2d& lower)
      : x(upper.x),
        y(upper.y),
        per_row(lower.y > upper.y ? (lower.x - upper.x) / (lower.y - upper.y) : 0) {}

  double At(double row) const { return x + per_row * (row - y); }
};

}  // namespace

void DepthBuffer::Clear(cv::Size size) {
  if (inverse_depth_.size() == size) {
    inverse_depth_(reach_).setTo(0);
    nearest_(reach_).setTo(kNothing);
  } else {
    inverse_depth_ = cv::Mat1f::zeros(size);
    nearest_ = cv::Mat1i(size, kNothing);
  }
  reach_ = {};
}

void DepthBuffer::AddTriangle(const Sight& a, const Sight& b, const Sight& c, int name) {
  const Plane depth = Plane::Through({a.pixel, b.pixel, c.pixel},
                                     {a.inverse_depth, b.inverse_depth, c.inverse_depth});
  if (!depth.exists) return;
  std::array<cv::Point2d, 3> down{a.pixel, b.pixel, c.pixel};
  std::sort(down.begin(), down.end(), [](const auto& p, const auto& q) { return p.y < q.y; });
  const Side whole(down[0], down[2]), upper(down[0], down[1]), lower(down[1], down[2]);

  const int first_row = std::max(0, static_cast<int>(std::ceil(down[0].y)));
  const int last_row = std::min(inverse_depth_.rows - 1, static_cast<int>(std::floor(down[2].y)));
  const auto step = static_cast<float>(depth.per_x);
  int leftmost = inverse_depth_.cols, rightmost = -1;
  for (int y = first_row; y <= last_row; ++y) {
    const double p = whole.At(y), q = y < down[1].y ? upper.At(y) : lower.At(y);
    const int first = std::max(0, static_cast<int>(std::ceil(std::min(p, q))));
    const int last =
        std::min(inverse_depth_.cols - 1, static_cast<int>(std::floor(std::max(p, q))));
    float* row = inverse_depth_[y];
    int* names = nearest_[y];
    const auto start = static_cast<float>(depth.At(first, y));
    for (int x = first; x <= last; ++x) {
      const float here = start + step * static_cast<float>(x - first);
      if (here <= row[x]) continue;
      row[x] = here;
      names[x] = name;
    }
    if (first > last) continue;
    leftmost = std::min(leftmost, first);
    rightmost = std::max(rightmost, last);
  }
  if (leftmost > rightmost) return;
  reach_ |= cv::Rect(leftmost, first_row, rightmost - leftmost + 1, last_row - first_row + 1);
}

bool DepthBuffer::Hides(const cv::Point2d& pixel, double inverse_depth) const {
  const int x = cvRound(pixel.x);
  const int y = cvRound(pixel.y);
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
