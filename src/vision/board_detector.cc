#include "softforce/vision/board_detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softforce/base/input_error.h"
#include "vision/board_start.h"
#include "vision/circle_grid.h"
#include "vision/local_map.h"
#include "vision/saddle_fit.h"

namespace softforce::vision {
namespace {

double Median(std::vector<double> values) {
  if (values.empty()) return NAN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct FittedCorner {
  int id;
  Eigen::Vector2d place;  // m
  SaddleFit fit;
};

BoardSightings SightingsOf(const std::vector<FittedCorner>& corners, int without_id = -1) {
  BoardSightings sightings;
  for (const FittedCorner& corner : corners) {
    if (corner.id == without_id) continue;
    sightings.places.push_back(corner.place);
    sightings.pixels.push_back(corner.fit.pixel);
  }
  return sightings;
}

bool IsNear(const BoardSightings& sightings, const Eigen::Vector2d& place, double range) {
  return std::any_of(sightings.places.begin(), sightings.places.end(),
                     [&](const Eigen::Vector2d& seen) { return (seen - place).norm() < range; });
}

// Every point of the board that lies near a sighting, measured where the sightings let expect it.
std::vector<FittedCorner> FitCorners(const cv::Mat& grey, const Board& board,
                                     const BoardStart& start, SaddleOptions saddle, double border) {
  const double cell = board.CellSize();
  std::vector<FittedCorner> corners;
  for (int id = 0; id < board.NumPoints(); ++id) {
    const Eigen::Vector2d place = board.Point(id).head<2>();
    if (!IsNear(start.sightings, place, 1.6 * cell)) continue;
    const auto map = FitLocalMap(start.sightings, place, cell);
    if (!map) continue;
    const auto fit = FitSaddle(grey, *map, PrintAround(board, id, start.top_left_black), saddle);
    if (!fit) continue;
    const Eigen::Vector2d& p = fit->pixel;
    const bool inside = p.minCoeff() >= border && p.x() <= grey.cols - 1 - border &&
                        p.y() <= grey.rows - 1 - border;
    if (inside) corners.push_back({id, place, *fit});
  }
  return corners;
}

// Leaves out corners that are not where their neighbours let expect them.
void DropStrays(const Board& board, double cell_px, std::vector<FittedCorner>* corners) {
  const double tolerance = std::max(1.0, 0.06 * cell_px);  // px; a lens bends less over a square
  std::vector<bool> stray(corners->size(), false);
  for (size_t k = 0; k < corners->size(); ++k) {
    const FittedCorner& corner = (*corners)[k];
    const auto map = FitLocalMap(SightingsOf(*corners, corner.id), corner.place, board.CellSize());
    if (!map) continue;
    stray[k] = (map->Pixel(Eigen::Vector2d::Zero()) - corner.fit.pixel).norm() > tolerance;
  }
  size_t k = 0;
  corners->erase(std::remove_if(corners->begin(), corners->end(),
                                [&](const FittedCorner&) { return stray[k++]; }),
                 corners->end());
}

// Median length (px) of the steps between successive points, in steps of the board's cell.
double CellInPicture(const Board& board, const BoardView& view) {
  std::vector<double> lengths;
  for (int k = 0; k + 1 < view.size(); ++k) {
    const double step = (board.Point(view.ids[k + 1]) - board.Point(view.ids[k])).norm();
    if (step > 2.5 * board.CellSize()) continue;  // the next row
    lengths.push_back((view.pixels[k + 1] - view.pixels[k]).norm() * board.CellSize() / step);
  }
  return Median(std::move(lengths));
}

BoardStart FindStart(const cv::Mat& grey, const Board& board) {
  if (board.kind == Board::Kind::kChessboard) return FindChessboard(grey, board);
  if (board.kind == Board::Kind::kCharuco) return FindCharuco(grey, board);
  return FindAprilGrid(grey, board);
}

void DetectCorners(const cv::Mat& grey, const Board& board, const BoardOptions& options,
                   BoardDetection* detection) {
  BoardStart start = FindStart(grey, board);
  detection->reason = start.reason;
  if (start.sightings.places.empty()) return;
  SaddleOptions saddle;
  saddle.min_contrast = options.min_contrast;
  saddle.max_reach_px = options.max_window_px;
  saddle.max_reach = std::min(0.4, options.max_window) * board.CellSize();
  std::vector<FittedCorner> corners = FitCorners(grey, board, start, saddle, options.border);
  // Again, with windows that follow the corners themselves, and as long as that leads to more.
  constexpr int kMaxRounds = 5;
  for (int round = 0; round < kMaxRounds && corners.size() >= 6; ++round) {
    const size_t before = corners.size();
    start.sightings = SightingsOf(corners);
    saddle.max_reach = options.max_window * board.CellSize();
    corners = FitCorners(grey, board, start, saddle, options.border);
    if (corners.size() <= before) break;
  }
  std::vector<double> blurs;
  for (const FittedCorner& corner : corners) blurs.push_back(corner.fit.blur);
  detection->blur = Median(std::move(blurs));
  const auto fill = [&] {
    detection->view = {};
    for (const FittedCorner& corner : corners) {
      detection->view.ids.push_back(corner.id);
      detection->view.pixels.push_back(corner.fit.pixel);
      detection->view.covariances.push_back(corner.fit.covariance);
    }
    detection->cell = CellInPicture(board, detection->view);
  };
  fill();
  DropStrays(board, detection->cell, &corners);
  fill();
}

}  // namespace

void BoardOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("board detection: ") + option, rule);
  };
  require(min_points >= 4, "min_points", "must be 4 or more");
  require(max_window > 0 && max_window <= 1, "max_window", "must lie between 0 and 1 squares");
  require(max_window_px >= 3, "max_window_px", "must be 3 px or more");
  require(min_contrast > 0, "min_contrast", "must be > 0 grey levels");
  require(border >= 0, "border", "must be 0 px or more");
}

BoardDetection DetectBoard(const cv::Mat& grey, const Board& board, const BoardOptions& options) {
  CV_Assert(grey.type() == CV_8UC1);
  options.Check();
  board.Check();
  BoardDetection detection;
  if (board.kind == Board::Kind::kCircles) {
    detection.view = FindCircles(grey, board, &detection.blur, &detection.reason);
    detection.cell = CellInPicture(board, detection.view);
  } else {
    DetectCorners(grey, board, options, &detection);
  }
  if (!detection.reason.empty()) {
    detection.status = BoardDetection::Status::kNotFound;
    detection.view = {};
  } else if (detection.view.size() < options.min_points) {
    detection.status = BoardDetection::Status::kTooFewPoints;
    detection.reason = fmt::format(
        "{} of the board's {} points can be measured, at least {} are "
        "needed: it is too small, blurred or covered",
        detection.view.size(), board.NumPoints(), options.min_points);
    detection.view = {};
  } else {
    detection.status = BoardDetection::Status::kOk;
  }
  return detection;
}

}  // namespace softforce::vision
