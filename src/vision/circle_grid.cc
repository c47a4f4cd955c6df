#include "vision/circle_grid.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "softforce/vision/dots.h"
#include "vision/local_map.h"

namespace softforce::vision {
namespace {

// The dots in the grid's order, as OpenCV finds it: from a corner of its choice, maybe mirrored.
std::vector<const Dot*> InOrder(const std::vector<Dot>& dots, const Board& board) {
  std::vector<cv::Point2f> points, ordered;
  for (const Dot& dot : dots) {
    points.emplace_back(static_cast<float>(dot.centroid.x()), static_cast<float>(dot.centroid.y()));
  }
  if (static_cast<int>(points.size()) < board.NumPoints()) return {};
  const cv::Size size(board.columns, board.rows);
  bool found = false;
  for (const int flags : {int(cv::CALIB_CB_ASYMMETRIC_GRID),
                          cv::CALIB_CB_ASYMMETRIC_GRID | cv::CALIB_CB_CLUSTERING}) {
    found = cv::findCirclesGrid(points, size, ordered, flags, nullptr);
    if (found) break;
  }
  if (!found) return {};
  std::vector<const Dot*> result;
  for (const cv::Point2f& p : ordered) {
    size_t nearest = 0;
    for (size_t k = 1; k < points.size(); ++k) {
      if (cv::norm(points[k] - p) < cv::norm(points[nearest] - p)) nearest = k;
    }
    result.push_back(&dots[nearest]);
  }
  return result;
}

// Root mean square distance (px) from one homography of the whole board, and whether it is seen
// from its front.
std::pair<double, bool> Fit(const Board& board, const std::vector<const Dot*>& dots) {
  std::vector<cv::Point2d> places, pixels;
  for (int id = 0; id < board.NumPoints(); ++id) {
    const Eigen::Vector3d place = board.Point(id);
    places.emplace_back(place.x(), place.y());
    pixels.emplace_back(dots[id]->centroid.x(), dots[id]->centroid.y());
  }
  const cv::Mat H = cv::findHomography(places, pixels);
  if (H.empty()) return {INFINITY, false};
  std::vector<cv::Point2d> projected;
  cv::perspectiveTransform(places, projected, H);
  double square = 0;
  for (size_t k = 0; k < pixels.size(); ++k) {
    square += (projected[k] - pixels[k]).ddot(projected[k] - pixels[k]);
  }
  return {std::sqrt(square / double(pixels.size())), cv::determinant(H) * H.at<double>(2, 2) > 0};
}

// The order in which ids rise: with the shift of every other row where Board has it, from the
// front, and upright where both ways do.
std::vector<const Dot*> Upright(const Board& board, const std::vector<const Dot*>& dots) {
  std::vector<const Dot*> best;
  double best_score = -INFINITY, cell = 0;
  for (int turn = 0; turn < 4; ++turn) {
    std::vector<const Dot*> turned;
    for (int i = 0; i < board.rows; ++i) {
      for (int j = 0; j < board.columns; ++j) {
        const int row = (turn & 1) != 0 ? board.rows - 1 - i : i;
        const int column = (turn & 2) != 0 ? board.columns - 1 - j : j;
        turned.push_back(dots[row * board.columns + column]);
      }
    }
    const auto [rms, from_front] = Fit(board, turned);
    const Eigen::Vector2d along = turned[board.columns - 1]->centroid - turned[0]->centroid;
    cell = along.norm() / (2 * (board.columns - 1));
    if (!from_front || rms > 0.25 * cell) continue;  // the wrong shift is off by half a cell
    const double score = along.normalized().x();
    if (score > best_score) {
      best_score = score;
      best = turned;
    }
  }
  return best;
}

// From the picture of a disc's centre to the centroid of the disc's picture, both under `map`.
Eigen::Vector2d CentroidOffset(const LocalMap& map, double radius) {
  Eigen::Matrix3d conic = Eigen::Vector3d(1, 1, -radius * radius).asDiagonal();
  conic = map.offset_from_pixel.transpose() * conic * map.offset_from_pixel;
  const Eigen::Vector2d centre =
      -conic.topLeftCorner<2, 2>().inverse() * conic.topRightCorner<2, 1>();
  return centre - map.Pixel(Eigen::Vector2d::Zero());
}

// Blur of a dot's edge, px: the steepest slope across a blurred step is its height over √(2π) times
// the blur.
double EdgeBlur(const cv::Mat& grey, const Dot& dot) {
  constexpr int kRays = 12;
  std::vector<double> slopes;
  const double reach = 0.75 * dot.long_axis;  // from the centroid, beyond the edge
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle = 2 * M_PI * ray / kRays;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    double steepest = 0;
    for (double r = 0.5 * dot.short_axis - 2; r < reach; r += 0.5) {
      const cv::Point at(cvRound(dot.centroid.x() + r * along.x()),
                         cvRound(dot.centroid.y() + r * along.y()));
      if (at.x < 1 || at.y < 1 || at.x > grey.cols - 2 || at.y > grey.rows - 2) break;
      const double dx = 0.5 * (grey.at<uchar>(at.y, at.x + 1) - grey.at<uchar>(at.y, at.x - 1));
      const double dy = 0.5 * (grey.at<uchar>(at.y + 1, at.x) - grey.at<uchar>(at.y - 1, at.x));
      steepest = std::max(steepest, std::hypot(dx, dy));
    }
    slopes.push_back(std::max(steepest, 1e-3));
  }
  std::nth_element(slopes.begin(), slopes.begin() + kRays / 2, slopes.end());
  return std::abs(dot.contrast) / (std::sqrt(2 * M_PI) * slopes[kRays / 2]);
}

}  // namespace

BoardView FindCircles(const cv::Mat& grey, const Board& board, double* blur, std::string* reason) {
  DotOptions options;
  options.polarity = DotPolarity::kDark;
  options.max_diameter = 0.5 * std::min(grey.cols, grey.rows);
  const std::vector<Dot> all = DetectDots(grey, options);
  const std::vector<const Dot*> dots = [&] {
    const std::vector<const Dot*> ordered = InOrder(all, board);
    return ordered.empty() ? ordered : Upright(board, ordered);
  }();
  if (dots.empty()) {
    *reason = fmt::format("no asymmetric grid of {}x{} dark circles is in sight as a whole",
                          board.columns, board.rows);
    return {};
  }
  std::vector<double> blurs;
  for (const Dot* dot : dots) blurs.push_back(EdgeBlur(grey, *dot));
  std::nth_element(blurs.begin(), blurs.begin() + blurs.size() / 2, blurs.end());
  *blur = blurs[blurs.size() / 2];
  BoardSightings sightings;
  for (int id = 0; id < board.NumPoints(); ++id) {
    sightings.places.push_back(board.Point(id).head<2>());
    sightings.pixels.push_back(dots[id]->centroid);
  }
  BoardView view;
  for (int id = 0; id < board.NumPoints(); ++id) {
    const auto map = FitLocalMap(sightings, sightings.places[id], 2 * board.CellSize());
    if (!map) continue;
    view.ids.push_back(id);
    view.pixels.push_back(dots[id]->centroid - CentroidOffset(*map, 0.5 * board.diameter));
    view.covariances.push_back(dots[id]->covariance);
  }
  return view;
}

}  // namespace softforce::vision
